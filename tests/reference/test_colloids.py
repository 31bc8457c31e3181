"""Colloids: forces against the plain double loop, momentum, energy against the time step."""

from collections import Counter
from collections.abc import Iterator
from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import kstest

from lammps_inputs import Scene, initial_state
from lammps_inputs.scenes.channel import Channel
from lammps_inputs.system import FLUID, Interaction, PairPotential, System
from srd_driver.reference import ReferenceEngine, SimulationFault
from srd_driver.reference.colloids import ColloidForces
from srd_driver.reference.streaming import stream
from tests.hand_made import Mixture3D
from tests.parts import solvent_of
from tests.reference.blocking import mean_and_error

Array = NDArray[np.float64]

# narrow, short and light: the fluid fills in quickly, colloids meet each other, walls and images
CROWDED = Channel.make(
    length=14,
    width=8,
    colloids=3,
    colloid_radius=1.5,
    wall_sigma=1.5,
    density=5,
    collision_time=0.05,
    md_steps_per_collision=25,
    thermostat="none",
    gravity=0.5,
    spacing=3.1,
)


MIXTURE = Mixture3D.make(thermostat="none")


def double_loop(system: System, fluid: Array, colloids: Array) -> tuple[Array, Array]:
    """All forces (3.50) from every pair, positions (N, d); drives left out."""
    sizes, periodic = np.array(system.box.sizes), np.array(system.box.periodic)
    species = np.repeat([each.name for each in system.species], [s.count for s in system.species])

    def force(potential: PairPotential, separation: Array) -> Array:
        nearest = separation - np.where(periodic, sizes * np.round(separation / sizes), 0.0)
        r = np.linalg.norm(nearest, axis=-1)
        return np.asarray(nearest * (potential.force(r) / r)[..., None])

    on_fluid, on_colloids = np.zeros_like(fluid), np.zeros_like(colloids)
    for i, kind in enumerate(species):
        for interaction in system.interactions:
            pair, potential = (interaction.first, interaction.second), interaction.potential
            if pair == (kind, FLUID):
                pushed = force(potential, fluid - colloids[i])
                on_fluid += pushed
                on_colloids[i] -= pushed.sum(axis=0)
            for j, other in enumerate(species):
                if i != j and pair in ((kind, other), (other, kind)):
                    on_colloids[i] += force(potential, colloids[i] - colloids[j])
    return on_fluid, on_colloids + of_walls(system, colloids)


def of_walls(system: System, colloids: Array) -> Array:
    """Forces of the walls on the colloids (N, d)."""
    species = np.repeat([each.name for each in system.species], [s.count for s in system.species])
    forces = np.zeros_like(colloids)
    for wall in system.walls:
        for name, potential in wall.potentials:
            for i in np.flatnonzero(species == name):
                distance, inwards = colloids[i, wall.axis], 1
                if wall.side == "upper":
                    distance, inwards = system.box.sizes[wall.axis] - distance, -1
                forces[i, wall.axis] += inwards * potential.force(distance)
    return forces


def felt(system: System, colloids: Array) -> Iterator[Interaction]:
    """The interactions of pairs that are in reach of each other."""
    species = np.repeat([each.name for each in system.species], [s.count for s in system.species])
    for i, j in combinations(range(len(colloids)), 2):
        r = np.linalg.norm(system.box.nearest_image(colloids[i] - colloids[j]))
        for interaction in system.particle_interactions():
            pair = {interaction.first, interaction.second}
            if pair == {species[i], species[j]} and r < interaction.potential.cutoff:
                yield interaction


def find_pairs(forces: ColloidForces, engine: ReferenceEngine) -> None:
    forces.find_pairs(
        engine.fluid_positions.T,
        engine.fluid_velocities.T,
        engine.colloid_positions.T,
        engine.colloid_velocities.T,
    )


@pytest.mark.parametrize("scene", [CROWDED, MIXTURE], ids=["2D", "3D"])
def test_forces_equal_the_double_loop_and_add_up_to_the_walls(scene: Scene) -> None:
    system, random = scene.system, np.random.default_rng(1)
    engine = ReferenceEngine(scene)
    forces = ColloidForces(system, solvent_of(scene))
    met = Counter[Interaction]()
    for collision in range(300):
        if scene is MIXTURE and collision % 10 == 0:  # stirred, so that all kinds meet
            engine.colloid_velocities[:] = 2 * random.normal(size=(system.particles, 3))
        engine.advance(1)
        find_pairs(forces, engine)
        fluid, colloids = engine.fluid_positions, engine.colloid_positions
        on_fluid, on_colloids = forces.forces(fluid.T, colloids.T)
        plain_fluid, plain_colloids = double_loop(system, fluid, colloids)
        size = abs(plain_colloids).max() + abs(plain_fluid).max()
        np.testing.assert_allclose(on_fluid.T, plain_fluid, atol=1e-12 * size)
        np.testing.assert_allclose(on_colloids.T, plain_colloids, atol=1e-12 * size)
        total = on_fluid.sum(axis=1) + on_colloids.sum(axis=1)
        walls = of_walls(system, colloids).sum(axis=0)
        np.testing.assert_allclose(total, walls, atol=1e-12 * size)
        met.update(felt(system, colloids))
    assert set(met) == set(system.particle_interactions())  # each kind did meet the other
    assert met.total() > 10


def drives_on(system: System, target: str) -> Array:
    """Sum of the accelerations (d,)."""
    drives = [drive.acceleration for drive in system.drives if drive.target == target]
    return np.asarray(np.sum([np.zeros(3), *drives], axis=0)[: system.box.dimensions])


def integrate_everything(engine: ReferenceEngine) -> tuple[Array, ...]:
    """tau_c of velocity Verlet with the double loop at each step: positions and velocities."""
    system = engine.scene.system
    clock, masses = system.clock, system.masses[:, None]
    pulls = [np.tile(drives_on(system, each.name), (each.count, 1)) for each in system.species]
    wind, pull = drives_on(system, FLUID), np.concatenate(pulls)

    def accelerations() -> tuple[Array, Array]:
        on_fluid, on_colloids = double_loop(system, fluid, colloids)
        return on_fluid + wind, on_colloids / masses + pull

    fluid, fluid_v = engine.fluid_positions.copy(), engine.fluid_velocities.copy()
    colloids, colloids_v = engine.colloid_positions.copy(), engine.colloid_velocities.copy()
    time = clock.time_step
    of_fluid, of_colloids = accelerations()
    for _ in range(clock.steps_per_collision):
        r, v = fluid.T.copy(), fluid_v.T.copy()
        stream(r, v, of_fluid.T, time, system.box.sizes[1])
        fluid, fluid_v = r.T, v.T - 0.5 * time * of_fluid
        colloids_v = colloids_v + 0.5 * time * of_colloids
        colloids = colloids + time * colloids_v
        of_fluid, of_colloids = accelerations()
        fluid_v = fluid_v + 0.5 * time * of_fluid
        colloids_v = colloids_v + 0.5 * time * of_colloids
    return fluid, fluid_v, colloids, colloids_v


@pytest.mark.parametrize("boost", [0.0, 8.0])
@pytest.mark.parametrize("scene", [CROWDED, MIXTURE], ids=["2D", "3D"])
def test_a_collision_interval_misses_no_force(
    scene: Scene, boost: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    # boost: a colloid far faster than the pairs allow, so that they must be found anew in time
    monkeypatch.setattr(ReferenceEngine, "_collide", lambda self: None)
    engine, box = ReferenceEngine(scene), scene.system.box
    engine.advance(40)
    engine.colloid_velocities[0, 1] += boost
    for _ in range(3):
        expected = integrate_everything(engine)
        engine.advance(1)
        for positions, plain in (
            (engine.fluid_positions, expected[0]),
            (engine.colloid_positions, expected[2]),
        ):
            np.testing.assert_allclose(box.nearest_image(positions - plain), 0, atol=1e-10)
        np.testing.assert_allclose(engine.fluid_velocities, expected[1], atol=1e-9)
        np.testing.assert_allclose(engine.colloid_velocities, expected[3], atol=1e-9)


def test_colloid_falls_freely_without_fluid_and_walls() -> None:
    scene = Channel.make(gravity=0.3, hydrodynamics="bath", collision_time=0.5)
    state = initial_state(scene.system, scene.seed)
    state.fluid_positions[:] = [0.0, 0.1]  # out of reach of the colloids on the mid-line
    state.fluid_velocities[:] = 0
    state.colloid_velocities[:] = [0.2, 0]
    engine = ReferenceEngine(scene, state)
    assert engine._coupling is not None
    engine._molecular_dynamics(engine._coupling)
    start = initial_state(scene.system, scene.seed).colloid_positions[:, 0]
    x = start + 0.2 * 0.5 + 0.3 * 0.5**2 / 2
    np.testing.assert_allclose(engine.colloid_positions[:, 0], x, rtol=1e-14)
    np.testing.assert_allclose(engine.colloid_velocities[:, 0], 0.2 + 0.3 * 0.5, rtol=1e-14)


def test_images_count_the_turns() -> None:
    scene = Channel.make(collision_time=0.1, gravity=0.0)
    engine = ReferenceEngine(scene)
    engine.colloid_velocities[:] = [-30.0, 0.0]
    engine.fluid_velocities[:] = [-30.0, 0.0]
    start = engine.colloid_positions[:, 0].copy()
    engine.advance(5)
    x = engine.colloid_positions[:, 0]
    assert ((x >= 0) & (x < scene.length)).all()
    assert engine.colloid_images.tolist() == [[-1, 0], [0, 0], [0, 0]]
    unwrapped = x + scene.length * engine.colloid_images[:, 0]
    np.testing.assert_allclose(unwrapped - start, -15, atol=0.5)


def test_energy_error_has_the_slope_of_velocity_verlet(monkeypatch: pytest.MonkeyPatch) -> None:
    # the molecular dynamics alone, from one equilibrated state: error of the energy ~ tau_MD^2
    monkeypatch.setattr(ReferenceEngine, "_collide", lambda self: None)
    steps = np.array([8, 16, 32, 64])
    errors = []
    for count in steps:
        scene = Channel.make(length=16, colloids=1, gravity=0.0, md_steps_per_collision=count)
        engine = ReferenceEngine(scene)
        energies = [engine.energy()]
        for _ in range(40):
            engine.advance(1)
            energies.append(engine.energy())
        errors.append(np.sqrt(np.mean((np.array(energies) - energies[0]) ** 2)))
    slope = np.polyfit(np.log(1 / steps), np.log(errors), 1)[0]
    print(f"\nenergy error {errors} kBT at {steps} MD steps in tau_c = 0.015: slope {slope:.3f}")
    assert slope == pytest.approx(2, abs=0.15)


class TestFaults:
    def test_fluid_particle_in_a_core(self) -> None:
        engine = ReferenceEngine(Channel.make())
        engine.fluid_positions[17] = engine.colloid_positions[1] + [0.3, 0]
        with pytest.raises(SimulationFault, match=r"step 0: fluid particle 17 is 0.3 .* colloid 1"):
            engine.advance(1)

    def test_colloids_in_each_other(self) -> None:
        engine = ReferenceEngine(Channel.make(hydrodynamics="bath"))
        engine.colloid_positions[2] = engine.colloid_positions[0] + [0.1, 0]
        with pytest.raises(SimulationFault, match=r"colloid 0 is 0\.1 from the centre of"):
            engine.advance(1)

    def test_colloid_through_a_wall(self) -> None:
        engine = ReferenceEngine(Channel.make(wall_strength=0))
        engine.colloid_velocities[1] = [0, 8000]
        with pytest.raises(SimulationFault, match=r"step 1: colloid 1 is at y = 1[23]\.\d+"):
            engine.advance(1)

    def test_velocity_that_is_not_a_number(self) -> None:
        engine = ReferenceEngine(Channel.make())
        engine.advance(2)
        engine.fluid_velocities[5, 1] = np.nan
        with pytest.raises(SimulationFault, match=r"step 30: fluid particle 5 .*not a number"):
            engine.advance(1)

    def test_colloid_position_that_is_not_a_number(self) -> None:
        engine = ReferenceEngine(Channel.make())
        engine.colloid_positions[2, 0] = np.inf
        with pytest.raises(SimulationFault, match=r"step 0: colloid 2 .*not a number"):
            engine.advance(1)

    def test_fluid_beyond_a_wall(self) -> None:
        engine = ReferenceEngine(Channel.make())
        engine.fluid_positions[3] = [1, 12]
        with pytest.raises(SimulationFault, match="fluid particle 3 is at y = 12"):
            engine.advance(1)


@pytest.mark.statistics
def test_maxwell_distribution_of_fluid_and_colloids() -> None:
    """Temperatures of both species and their velocity distributions at rest.

    python -m pytest -m statistics -s tests/reference/test_colloids.py
    """
    # six MD steps are enough: the energy error per collision is below 1e-3 kBT
    scene = Channel.make(length=60, colloids=10, gravity=0.0, md_steps_per_collision=6, seed=1)
    engine = ReferenceEngine(scene)
    engine.advance(500)
    fluid, colloids, rows = [], [], []
    for sample in range(10_000):
        engine.advance(2)
        fluid.append(np.mean(engine.fluid_velocities**2))
        colloids.append(scene.colloid_mass * engine.colloid_velocities**2)
        if sample % 20 == 0:  # 0.6 t0: twice the time in which a colloid forgets its velocity
            rows.append(engine.colloid_velocities * np.sqrt(scene.colloid_mass))
    fluid_t, fluid_error = mean_and_error(np.array(fluid))
    colloid_t, colloid_error = mean_and_error(np.mean(colloids, axis=(1, 2)))
    print(f"\nfluid T {fluid_t:.5f} +- {fluid_error:.5f}")
    print(f"colloid T {colloid_t:.4f} +- {colloid_error:.4f}")
    p_fluid = kstest(engine.fluid_velocities.ravel(), "norm").pvalue
    p_colloids = kstest(np.concatenate(rows).ravel(), "norm").pvalue
    print(f"Kolmogorov-Smirnov p: fluid {p_fluid:.3f}, colloids {p_colloids:.3f}")
    # four standard errors each, and p at 1e-4: a false alarm once in 3000 runs
    assert abs(fluid_t - 1) < 4 * fluid_error
    assert abs(colloid_t - 1) < 4 * colloid_error
    assert p_fluid > 1e-4
    assert p_colloids > 1e-4
