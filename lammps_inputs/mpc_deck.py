"""The deck of `fix mpc`: the fluid lives in the fix, LAMMPS's atoms are the colloids."""

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from lammps_inputs import Bulk, Channel, InitialState, Scene, initial_state
from lammps_inputs.deck_lines import Start, box, head, observables, read, run, trajectory

SKIN = 0.5  # of the neighbour list [a0]
LONGEST_STEP = 0.032  # in r_c sqrt(mu): at 0.030 temperatures hold, at 0.0375 runs break


def problems(scene: Scene) -> Iterator[str]:
    """What the forces between colloids and fluid do not allow, one line each.

    A thermal collision takes about r_c sqrt(mu) / 6, mu the reduced mass of colloid and particle.
    """
    if not isinstance(scene, Channel):
        return
    reduced_mass = scene.colloid_mass / (1 + scene.colloid_mass)
    longest = LONGEST_STEP * scene.colloid_radius * math.sqrt(reduced_mass)
    if scene.time_step > longest:
        yield (
            f"md_steps_per_collision = {scene.md_steps_per_collision!r}: steps of "
            f"{scene.time_step:.4g} let fluid fly into the colloids; at most {longest:.2g}, which "
            f"takes {math.ceil(scene.collision_time / longest)} steps"
        )


def write(scene: Scene, directory: Path) -> None:
    """What the input script reads: the colloids, and the fluid."""
    state = initial_state(scene)
    with (directory / "state.data").open("w", encoding="utf-8") as file:
        file.writelines(_data(scene, state))
    (directory / "state.fluid").write_bytes(fluid_file(state))


def fluid_file(state: InitialState, collisions: int = 0) -> bytes:
    """The fluid of a state as `fix mpc ... load` reads it (docs/fix_mpc.md)."""
    count, dimensions = state.fluid_positions.shape
    rows = np.column_stack([np.arange(count), state.fluid_positions, state.fluid_velocities])
    header = np.array([dimensions, count, collisions], dtype="<i8")
    return b"mpcfluid" + header.tobytes() + rows.astype("<f8").tobytes()


def lines(scene: Scene, start: Start) -> Iterator[str]:
    """The input script."""
    gravity = scene.gravity if isinstance(scene, Channel) else scene.fluid_gravity
    yield from head(scene, gravity, {"seed": scene.seed})
    yield "atom_modify sort 0 0.0 # the order of the atoms decides the last bit of sums"
    yield from read(start)
    if not start.checkpoint:
        yield "group colloids type 1"
    yield ""
    if isinstance(scene, Channel):
        yield "# 48-24 repulsion of the colloids"
        yield f"pair_style mie/cut {scene.colloid_colloid.cutoff!r}"
        yield scene.colloid_colloid.pair_coeff("1 1")
        yield "pair_modify shift yes"
        yield f"neighbor {SKIN!r} bin"
        yield "neigh_modify delay 0 every 1 check yes"
        if _ghost_cutoff(scene) > scene.colloid_colloid.cutoff + SKIN:
            yield f"comm_modify cutoff {_ghost_cutoff(scene):.6g} # the fluid sees colloids so far"
    else:
        yield "pair_style none"
        yield "comm_modify cutoff 1.0"
    yield f"timestep {scene.time_step!r}"
    if isinstance(scene, Channel):
        yield "fix motion colloids nve"
        if scene.wall_strength > 0:
            yield scene.colloid_wall.wall_fix("wall", "colloids")
        if scene.gravity:
            yield "fix gravity colloids gravity ${gravity} vector 1 0 0"
    yield ""
    yield "# the MPC solvent"
    yield from _solvent(scene, start)
    yield ""
    yield "# output, averaged over each sampling interval; the solvent writes its own profile"
    yield "variable fluid_temperature equal f_solvent"
    if isinstance(scene, Channel):
        momentum = "(f_solvent[1]+mass(colloids)*vcm(colloids,x))"
        yield f"variable mean_velocity_x equal {momentum}/(f_solvent[4]+mass(colloids))"
    else:
        yield "variable mean_velocity_x equal f_solvent[1]/f_solvent[4]"
    yield from observables(scene, start)
    if isinstance(scene, Channel):
        yield from trajectory(start)
    yield from run()


def _ghost_cutoff(scene: Channel) -> float:
    """How far from its cells the fluid has to see colloids: what fix mpc asks for [a0].

    1.5 cells, the range of the force, and the flights of one collision interval: 7 thermal speeds
    of the fluid, and 3 times the fastest colloid's: a drift of at most 1, 7 thermal speeds of its
    own, and 3 that it may gain.
    """
    colloid_speed = 1 + 10 / math.sqrt(scene.colloid_mass)
    return 1.5 + scene.colloid_fluid.cutoff + scene.collision_time * (7 + 3 * colloid_speed)


def _solvent(scene: Scene, start: Start) -> Iterator[str]:
    colloids = "colloids" if isinstance(scene, Channel) else "NULL"
    looks = scene.fluid_looks
    options = ["load state.fluid", f"density {scene.density!r}", f"angle {scene.angle!r}"]
    if isinstance(scene, Bulk) and scene.dimension == 3:
        options.append(f"axis {scene.rotation.partition('_')[0]}")
    options += [f"tstat {scene.thermostat}", f"hydro {scene.hydrodynamics}"]
    if scene.fluid_gravity:
        options.append("field ${gravity} 0 0")
    if isinstance(scene, Channel):
        potential = scene.colloid_fluid
        options.append(f"force 1 {potential.epsilon!r} {potential.sigma!r}")
    mode = "append" if start.checkpoint else "file"
    options.append(f"bins {2 * round(scene.width)}")
    options.append(f"profile {scene.sample_steps // looks} ${{sample}} {mode} fluid_profile.dat")
    yield (
        f"fix solvent all mpc {scene.steps_per_collision} {colloids} 1.0 1.0 ${{seed}} "
        + " ".join(options)
    )


def _data(scene: Scene, state: InitialState) -> Iterable[str]:
    """The data file without the fluid: the box, and the colloids if there are any."""
    mass = scene.colloid_mass if isinstance(scene, Channel) else 1.0
    yield f"# narrows: initial colloids of the scene {scene.name}\n\n"
    yield f"{scene.colloids} atoms\n1 atom types\n\n"
    yield from box(scene)
    yield f"\nMasses\n\n1 {mass!r}\n"
    if scene.colloids:
        yield "\nAtoms # atomic\n\n"
        for i, (x, y) in enumerate(state.colloid_positions.tolist(), start=1):
            yield f"{i} 1 {x!r} {y!r} 0.0\n"
        yield "\nVelocities\n\n"
        for i, (x, y) in enumerate(state.colloid_velocities.tolist(), start=1):
            yield f"{i} {x!r} {y!r} 0.0\n"
