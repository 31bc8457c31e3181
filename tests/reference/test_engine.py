"""The engine as a whole: order of operations by hand, save and load, what the output needs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import InitialState, Scene, make_scene
from lammps_inputs.scenes.bulk import Bulk
from lammps_inputs.scenes.channel import Channel
from srd_driver.reference import ReferenceEngine
from srd_driver.reference.counter_random import CounterRandom, Stream, uniform
from tests.hand_made import Mixture3D, Slit3D
from tests.parts import solvent_of

CASES: list[tuple[str, dict[str, Any]]] = [
    ("bulk", {"length": 6, "width": 5, "shear_wave": 0.5}),
    ("bulk", {"dimension": 3, "length": 4, "width": 5, "height": 3, "thermostat": "layer"}),
    (
        "bulk",
        {"dimension": 3, "length": 4, "width": 4, "rotation": "random_axis", "angle": 130},
    ),
    ("poiseuille", {"length": 6, "width": 5.5, "thermostat": "monte_carlo"}),
    ("poiseuille", {"length": 6, "width": 5, "thermostat": "andersen"}),
    ("poiseuille", {"length": 6, "width": 5, "thermostat": "rescale", "hydrodynamics": "bath"}),
    ("channel", {"length": 12, "colloids": 2}),
    ("channel", {"length": 12, "colloids": 1, "hydrodynamics": "shuffle"}),
]
SCENES = [
    *(make_scene(name, **fields) for name, fields in CASES),
    Slit3D.make(thermostat="monte_carlo", diagonal=True),
    Mixture3D.make(),
]


@pytest.mark.parametrize("scene", SCENES, ids=str)
def test_continuation_is_bitwise_identical(scene: Scene, tmp_path: Path) -> None:
    whole = ReferenceEngine(scene)
    whole.advance(12)
    part = ReferenceEngine(scene)
    part.advance(5)
    part.save(tmp_path / "state")
    rest = ReferenceEngine.load(scene, tmp_path / "state")
    rest.advance(7)
    assert rest.collisions == 12
    assert rest.time == whole.time == pytest.approx(12 * solvent_of(scene).collision_time)
    for array in (
        "fluid_positions",
        "fluid_velocities",
        "colloid_positions",
        "colloid_velocities",
        "colloid_images",
    ):
        np.testing.assert_array_equal(getattr(rest, array), getattr(whole, array))


@pytest.mark.parametrize("scene", SCENES, ids=str)
def test_everything_stays_in_the_box(scene: Scene) -> None:
    engine = ReferenceEngine(scene)
    engine.advance(25)
    box = scene.system.box
    assert engine.fluid_positions.shape == (solvent_of(scene).particles, box.dimensions)
    assert (engine.fluid_positions >= 0).all()
    assert (engine.fluid_positions <= box.sizes).all()
    assert (engine.fluid_positions < box.sizes)[:, box.periodic].all()
    if scene.system.species:
        assert (engine.colloid_positions >= 0).all()
        assert (engine.colloid_positions < box.sizes).all()


def test_one_collision_by_hand() -> None:
    """Two particles alone in one cell: flight, wrap, cell, rotation, with the documented words."""
    scene = Bulk.make(
        length=4, width=4, density=2 / 16, angle=90, collision_time=1.0, thermostat="none", seed=1
    )
    state = InitialState(
        np.array([[3.5, 2.0], [3.6, 2.2]]),
        np.array([[1.0, 0.0], [1.0, -0.2]]),
        np.empty((0, 2)),
        np.empty((0, 2)),
    )
    engine = ReferenceEngine(scene, state)
    engine.advance(1)
    np.testing.assert_allclose(engine.fluid_positions, [[0.5, 2.0], [0.6, 2.0]], atol=1e-15)
    random = CounterRandom(1, 0)
    shift = random.uniform(Stream.SHIFT, 1)[:2, 0]
    first, second = np.floor(engine.fluid_positions + shift).astype(int) % 4
    assert first.tolist() == second.tolist()  # true for this seed
    cell = first[0] + 4 * first[1]
    sign = 1 if uniform(random.mixed(Stream.ROTATION, 16))[0, cell] < 0.5 else -1
    # mean (1, -0.1), relative velocities (0, +-0.1) turned to (-+ sign 0.1, 0)
    np.testing.assert_allclose(
        engine.fluid_velocities, [[1 - sign * 0.1, -0.1], [1 + sign * 0.1, -0.1]], atol=1e-15
    )


def test_a_scene_is_a_function_of_its_seed() -> None:
    def velocities(seed: int) -> Any:
        engine = ReferenceEngine(make_scene("poiseuille", length=6, width=5, seed=seed))
        engine.advance(3)
        return engine.fluid_velocities

    np.testing.assert_array_equal(velocities(1), velocities(1))
    assert not np.array_equal(velocities(1), velocities(2))


def test_mean_velocity_weighs_colloids_with_their_mass() -> None:
    scene = Channel.make(length=12, colloids=1)
    engine = ReferenceEngine(scene)
    engine.fluid_velocities[:] = [1.0, 0.0]
    engine.colloid_velocities[:] = [0.0, 2.0]
    mass, particles = scene.colloid_mass, solvent_of(scene).particles
    total = particles + mass
    expected = np.array([particles / total, 2 * mass / total])
    np.testing.assert_allclose(engine.mean_velocity(), expected, rtol=1e-13)


@pytest.mark.parametrize("dimension", [2, 3])
def test_temperature_leaves_out_the_flow_profile(dimension: int) -> None:
    # one standard error of T is sqrt(2 / (d N)); bound of 4.5: a false alarm once in 1e5 changes
    scene: Scene = Bulk.make(dimension=dimension, length=12, width=12, height=None)
    engine = ReferenceEngine(scene)
    error = np.sqrt(2 / engine.fluid_velocities.size)
    assert engine.fluid_temperature() == pytest.approx(1, abs=4.5 * error)
    engine.fluid_velocities[:, 0] += np.floor(2 * engine.fluid_positions[:, 1])
    assert engine.fluid_temperature() == pytest.approx(1, abs=4.5 * error)


def test_fields_of_hand_made_particles() -> None:
    scene = Bulk.make(length=2, width=2, density=1)
    state = InitialState(
        np.array([[0.1, 0.1], [0.2, 0.3], [0.3, 1.6], [0.4, 1.7]]),
        np.array([[1.0, 0], [3, 0], [0, 5], [0, 1]]),
        np.empty((0, 2)),
        np.empty((0, 2)),
    )
    engine = ReferenceEngine(scene, state)
    # half-cell bins 0 and 3: (1 + 1 + 4 + 4) over d (4 particles - 2 bins) degrees of freedom
    assert engine.fluid_temperature() == pytest.approx(10 / 4, rel=1e-15)
    assert engine.energy() == pytest.approx(0.5 * (1 + 9 + 25 + 1), rel=1e-15)
