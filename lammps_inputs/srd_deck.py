"""The deck of LAMMPS's own `fix srd`: the fluid is LAMMPS atoms that have no neighbours."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from lammps_inputs import Bulk, Channel, Poiseuille, Scene, initial_state
from lammps_inputs.deck_lines import Start, box, head, observables, read, run, trajectory, window

SEED_STREAM = 90  # Philox key of the seeds handed to fix srd, one block per start


def problems(scene: Scene) -> Iterator[str]:
    """What fix srd cannot do of a scene, one line each."""
    if scene.angle != 90:
        yield f"angle = {scene.angle!r}: fix srd rotates by 90 degrees only"
    if scene.hydrodynamics != "on":
        given = scene.hydrodynamics
        yield f"hydrodynamics = {given!r}: fix srd cannot switch them off; must be 'on'"
    if scene.thermostat not in ("none", "layer"):
        yield f"thermostat = {scene.thermostat!r}: fix srd rescales (layer) or does nothing (none)"
    if scene.width != round(scene.width):
        yield f"width = {scene.width!r}: fix srd needs a whole number of collision cells"
    if isinstance(scene, Bulk) and scene.dimension == 3 and scene.rotation != "coordinate_axes":
        yield f"rotation = {scene.rotation!r}: fix srd rotates about the coordinate_axes only"


def seeds(scene: Scene, step: int = 0) -> dict[str, int]:
    """Seeds of fix srd for a start at `step`: a resumed run must not repeat its random numbers."""
    words = np.random.Philox(key=[scene.seed, SEED_STREAM], counter=[step, 0, 0, 0])
    collision, shift = (int(word % 900_000_000) + 1 for word in words.random_raw(2))
    return {"seed_collision": collision, "seed_shift": shift}


def lines(scene: Scene, start: Start) -> Iterator[str]:
    """The input script."""
    return _channel(scene, start) if isinstance(scene, Channel) else _pure_fluid(scene, start)


def write(scene: Scene, directory: Path) -> None:
    """What the input script reads: the initial state, and the wall's table."""
    with (directory / "state.data").open("w", encoding="utf-8") as file:
        file.writelines(_data(scene))
    if isinstance(scene, Channel) and scene.wall_strength > 0:
        table = scene.colloid_wall.table_text()
        (directory / "wall.table").write_text(table, encoding="utf-8")


def _channel(scene: Channel, start: Start) -> Iterator[str]:
    yield from head(scene, scene.gravity, seeds(scene, start.step))
    yield "atom_style sphere"
    yield "atom_modify first colloids"
    yield from read(start)
    if start.checkpoint:
        yield "atom_modify first colloids"
    else:
        yield "group colloids type 1"
        yield "group fluid type 2"
        yield f"set group colloids mass {scene.colloid_mass!r}"
    yield ""
    yield "# only colloids have neighbours and ghosts: the fluid meets them inside fix srd"
    yield "neighbor 0.1 multi"
    yield "neigh_modify delay 0 every 1 check yes include colloids"
    yield "comm_modify mode multi group colloids vel yes"
    yield ""
    yield "# 48-24 repulsion of the colloids"
    yield f"pair_style mie/cut {scene.colloid_colloid.cutoff!r}"
    yield scene.colloid_colloid.pair_coeff("1 1")
    yield "pair_coeff * 2 0.0 1.0 48 24 0.0"
    yield "pair_modify shift yes"
    yield ""
    yield f"timestep {scene.time_step!r}"
    yield "fix motion colloids nve/sphere disc"
    if scene.wall_strength > 0:
        yield scene.colloid_wall.table_fix("wall", "colloids", "wall.table")
    if scene.gravity:
        yield "fix gravity colloids gravity ${gravity} vector 1 0 0"
    yield from _solvent(scene, "colloids", "overlap no inside ignore search 0.5 cubic warn 0.01")
    yield from _output(scene, start)
    yield from trajectory(start)
    yield from run()


def _pure_fluid(scene: Poiseuille | Bulk, start: Start) -> Iterator[str]:
    gravity = scene.fluid_gravity
    yield from head(scene, gravity, seeds(scene, start.step))
    yield "atom_style atomic"
    yield "atom_modify sort 100 1.0"
    yield from read(start)
    if not start.checkpoint:
        yield "group fluid type 1"
    yield ""
    yield "# the fluid has no neighbours and no ghosts"
    yield "pair_style none"
    yield "neighbor 0.0 bin"
    yield "neigh_modify delay 0 every 1 check no"
    yield "comm_modify vel yes cutoff 0.0"
    yield ""
    yield f"timestep {scene.time_step!r}"
    if gravity:
        yield "variable pulled atom vx+v_gravity*dt"
        yield "fix gravity fluid set 1 0 group fluid vx v_pulled # fix srd ignores forces"
    yield from _solvent(scene, "NULL", "")
    yield from _output(scene, start)
    yield from run()


def _solvent(scene: Scene, colloids: str, colloid_options: str) -> Iterator[str]:
    yield ""
    yield "# the MPC solvent; fix srd knows hard collisions with colloids and walls only"
    if scene.walls:
        yield "fix edges all wall/srd ylo EDGE yhi EDGE"
    options = ["shift yes ${seed_shift}"]
    if scene.walls:
        options.append("collision noslip")
    if scene.thermostat != "none":
        options.append("tstat yes")
    if colloid_options:
        options.append(colloid_options)
    yield (
        f"fix solvent fluid srd {scene.steps_per_collision} {colloids} 1.0 1.0 "
        "${seed_collision} " + " ".join(options)
    )


def _output(scene: Scene, start: Start) -> Iterator[str]:
    bins = 2 * round(scene.width)
    file = "append" if start.checkpoint else "file"
    yield ""
    yield "# output: fluid by half-cell bins along y, averaged over each sampling interval"
    yield f"compute layers fluid chunk/atom bin/1d y lower {scene.width / bins!r} units box"
    yield (
        f"fix profile fluid ave/chunk {window(scene)} layers density/number vx temp "
        f"{file} fluid_profile.dat"
    )
    yield f"compute thermal fluid temp/profile 1 0 0 y {bins}"
    yield "variable fluid_temperature equal c_thermal"
    yield "variable mean_velocity_x equal vcm(all,x)"
    yield from observables(scene, start)


def _data(scene: Scene) -> Iterable[str]:
    """The data file: the initial state, colloids first."""
    state = initial_state(scene)
    colloids = len(state.colloid_positions)
    atoms = colloids + len(state.fluid_positions)
    yield f"# narrows: initial state of the scene {scene.name}\n\n"
    yield f"{atoms} atoms\n{2 if colloids else 1} atom types\n\n"
    yield from box(scene)
    if not colloids:
        yield "\nMasses\n\n1 1.0\n"

    position = np.zeros((atoms, 3))
    velocity = np.zeros((atoms, 3))
    position[:colloids, : scene.dimensions] = state.colloid_positions
    position[colloids:, : scene.dimensions] = state.fluid_positions
    velocity[:colloids, : scene.dimensions] = state.colloid_velocities
    velocity[colloids:, : scene.dimensions] = state.fluid_velocities
    if isinstance(scene, Channel):
        diameter = 2 * scene.colloid_radius
        kinds = [f"1 {diameter!r} 1.0"] * colloids + ["2 0.0 1.0"] * (atoms - colloids)
        spin = " 0 0 0"
        yield "\nAtoms # sphere\n\n"
    else:
        kinds = ["1"] * atoms
        spin = ""
        yield "\nAtoms # atomic\n\n"
    for i, (kind, (x, y, z)) in enumerate(zip(kinds, position.tolist(), strict=True), start=1):
        yield f"{i} {kind} {x!r} {y!r} {z!r}\n"
    yield "\nVelocities\n\n"
    for i, (x, y, z) in enumerate(velocity.tolist(), start=1):
        yield f"{i} {x!r} {y!r} {z!r}{spin}\n"
