"""LAMMPS decks: a folder that plain `lmp -in in.lammps` runs, and `-var name value` changes.

A deck contains only what its scene needs. The run directory it fills is described in
docs/run-directory.md; the driver runs the very same lines.
"""

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from lammps_inputs.bulk import Bulk
from lammps_inputs.channel import Channel
from lammps_inputs.initial_state import InitialState, initial_state
from lammps_inputs.poiseuille import Poiseuille
from lammps_inputs.scene import SceneError
from lammps_inputs.viscosity import viscosity

Scene = Channel | Poiseuille | Bulk
Engine = Literal["srd", "mpc", "reference"]

MAX_COLLISIONS_PER_LOOK = 10  # its velocities decorrelate in a few collisions
SRD_SEED_STREAM = 90  # Philox key of the seeds handed to fix srd, one block per start


@dataclass(frozen=True)
class Start:
    """Where a deck starts: from `state.data` at step 0, or from a checkpoint at its step."""

    step: int = 0
    checkpoint: str | None = None


def check_engine(scene: Scene, engine: Engine) -> None:
    """Refuse what an engine cannot do.

    Raises:
        SceneError: naming the field, its value and what the engine allows.
    """
    if engine != "srd":
        return
    problems = []
    if scene.angle != 90:
        problems.append(f"angle = {scene.angle!r}: fix srd rotates by 90 degrees only")
    if scene.hydrodynamics != "on":
        problems.append(
            f"hydrodynamics = {scene.hydrodynamics!r}: fix srd cannot switch them off; must be 'on'"
        )
    if scene.thermostat not in ("none", "layer"):
        problems.append(
            f"thermostat = {scene.thermostat!r}: fix srd rescales (layer) or does nothing (none)"
        )
    if scene.width != round(scene.width):
        problems.append(f"width = {scene.width!r}: fix srd needs a whole number of collision cells")
    if isinstance(scene, Bulk) and scene.dimension == 3 and scene.rotation != "coordinate_axes":
        problems.append(
            f"rotation = {scene.rotation!r}: fix srd rotates about the coordinate_axes only"
        )
    if problems:
        raise SceneError(problems)


def srd_seeds(scene: Scene, step: int = 0) -> dict[str, int]:
    """Seeds of fix srd for a start at `step`: a resumed run must not repeat its random numbers."""
    words = np.random.Philox(key=[scene.seed, SRD_SEED_STREAM], counter=[step, 0, 0, 0])
    collision, shift = (int(word % 900_000_000) + 1 for word in words.random_raw(2))
    return {"seed_collision": collision, "seed_shift": shift}


def sample_steps(scene: Scene) -> int:
    """Engine steps between two outputs."""
    return scene.collisions_per_sample * scene.steps_per_collision


def fluid_looks(scene: Scene) -> int:
    """Evenly spaced looks at the fluid that one output averages, at least two.

    With a single one LAMMPS would also output at the step a run starts from.
    """
    sample = scene.collisions_per_sample
    longest = min(MAX_COLLISIONS_PER_LOOK, sample // 2)
    return next(sample // every for every in range(longest, 0, -1) if sample % every == 0)


def total_steps(scene: Scene) -> int:
    """Engine steps of the whole run."""
    return scene.collisions * scene.steps_per_collision


def manifest(scene: Scene, engine: Engine) -> dict[str, Any]:
    """All that analysis needs to know of the scene (docs/run-directory.md)."""
    equilibration = round(scene.equilibration / scene.collision_time) * scene.steps_per_collision
    return {
        "engine": engine,
        "scene": scene.name,
        "fields": scene.model_dump(),
        "dimension": scene.dimensions,
        "box": list(scene.box),
        "periodic": list(scene.periodic),
        "units": {"length": "a0", "energy": "kBT", "mass": "m_f", "time": "a0 sqrt(m_f/kBT)"},
        "time_step": scene.time_step,
        "steps_per_collision": scene.steps_per_collision,
        "sample_steps": sample_steps(scene),
        "fluid_looks": fluid_looks(scene),
        "equilibration_steps": equilibration,
        "total_steps": total_steps(scene),
        "fluid_particles": scene.fluid_particles,
        "colloids": scene.colloids,
        "colloid_mass": scene.colloid_mass if isinstance(scene, Channel) else None,
        "viscosity_theory": _viscosity_theory(scene),
        "seeds": {"seed": scene.seed, **(srd_seeds(scene) if engine == "srd" else {})},
    }


def _viscosity_theory(scene: Scene) -> float | None:
    """Kinetic theory's viscosity: none for a random solvent, or a 2D turn by 180 degrees."""
    if scene.hydrodynamics != "on" or (scene.dimensions == 2 and scene.angle == 180):
        return None
    rotation = scene.rotation if isinstance(scene, Bulk) else "coordinate_axes"
    return viscosity(scene.density, scene.collision_time, scene.angle, scene.dimensions, rotation)


def write_deck(scene: Scene, directory: Path, engine: Engine = "srd") -> None:
    """Write scene, input script, data, wall table and manifest into an existing folder.

    Raises:
        SceneError: when the engine cannot run the scene.
    """
    check_engine(scene, engine)
    (directory / "scene.toml").write_text(scene.toml(), encoding="utf-8")
    (directory / "manifest.json").write_text(
        json.dumps(manifest(scene, engine), indent=2) + "\n", encoding="utf-8"
    )
    if engine == "mpc":
        (directory / "in.lammps").write_text(script(scene, engine="mpc"), encoding="utf-8")
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            file.writelines(_mpc_data(scene))
        (directory / "state.fluid").write_bytes(fluid_file(initial_state(scene)))
    if engine == "srd":
        (directory / "in.lammps").write_text(script(scene), encoding="utf-8")
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            file.writelines(_data(scene))
        if isinstance(scene, Channel) and scene.wall_strength > 0:
            table = scene.colloid_wall.table_text()
            (directory / "wall.table").write_text(table, encoding="utf-8")


def script(scene: Scene, start: Start | None = None, engine: Engine = "srd") -> str:
    """The input script; its last command is the `run`."""
    start = start or Start()
    if engine == "mpc":
        parts = _mpc(scene, start)
    else:
        parts = _channel(scene, start) if isinstance(scene, Channel) else _pure_fluid(scene, start)
    return "\n".join(parts) + "\n"


def fluid_file(state: InitialState, collisions: int = 0) -> bytes:
    """The fluid of a state as `fix mpc ... load` reads it (docs/fix_mpc.md)."""
    count, dimensions = state.fluid_positions.shape
    rows = np.column_stack([np.arange(count), state.fluid_positions, state.fluid_velocities])
    header = np.array([dimensions, count, collisions], dtype="<i8")
    return b"mpcfluid" + header.tobytes() + rows.astype("<f8").tobytes()


def _mpc(scene: Scene, start: Start) -> Iterator[str]:
    pulled = isinstance(scene, Channel) and scene.gravity
    gravity = scene.gravity if isinstance(scene, Channel) else scene.fluid_gravity
    yield from _head(scene, gravity, {"seed": scene.seed})
    yield "atom_modify sort 0 0.0 # the order of the atoms decides the last bit of sums"
    yield from _read(start)
    if not start.checkpoint:
        yield "group colloids type 1"
    yield ""
    if isinstance(scene, Channel):
        yield "# 48-24 repulsion of the colloids"
        yield f"pair_style mie/cut {scene.colloid_colloid.cutoff!r}"
        yield scene.colloid_colloid.pair_coeff("1 1")
        yield "pair_modify shift yes"
        yield "neighbor 0.5 bin"
        yield "neigh_modify delay 0 every 1 check yes"
    else:
        yield "pair_style none"
        yield "comm_modify cutoff 1.0"
    yield f"timestep {scene.time_step!r}"
    if isinstance(scene, Channel):
        yield "fix motion colloids nve"
        if scene.wall_strength > 0:
            yield scene.colloid_wall.wall_fix("wall", "colloids")
    if pulled:
        yield "fix gravity colloids gravity ${gravity} vector 1 0 0"
    yield ""
    yield "# the MPC solvent"
    yield from _mpc_solvent(scene, start)
    yield ""
    yield "# output, averaged over each sampling interval; the solvent writes its own profile"
    yield "variable fluid_temperature equal f_solvent"
    if isinstance(scene, Channel):
        momentum = "(f_solvent[1]+mass(colloids)*vcm(colloids,x))"
        yield f"variable mean_velocity_x equal {momentum}/(f_solvent[4]+mass(colloids))"
    else:
        yield "variable mean_velocity_x equal f_solvent[1]/f_solvent[4]"
    yield from _observables(scene, start)
    if isinstance(scene, Channel):
        yield from _trajectory(start)
    yield from _run()


def _mpc_solvent(scene: Scene, start: Start) -> Iterator[str]:
    colloids = "colloids" if isinstance(scene, Channel) else "NULL"
    looks = fluid_looks(scene)
    options = ["load state.fluid", f"density {scene.density!r}", f"angle {scene.angle!r}"]
    if isinstance(scene, Bulk) and scene.dimension == 3:
        options.append(f"axis {scene.rotation.partition('_')[0].replace('axes', '')}")
    options += [f"tstat {scene.thermostat}", f"hydro {scene.hydrodynamics}"]
    if scene.fluid_gravity:
        options.append("field ${gravity} 0 0")
    if isinstance(scene, Channel):
        potential = scene.colloid_fluid
        options.append(f"force 1 {potential.epsilon!r} {potential.sigma!r}")
    mode = "append" if start.checkpoint else "file"
    options.append(f"bins {2 * round(scene.width)}")
    options.append(f"profile {sample_steps(scene) // looks} ${{sample}} {mode} fluid_profile.dat")
    yield (
        f"fix solvent all mpc {scene.steps_per_collision} {colloids} 1.0 1.0 ${{seed}} "
        + " ".join(options)
    )


def _head(scene: Scene, gravity: float | None, seeds: dict[str, int]) -> Iterator[str]:
    about = (type(scene).__doc__ or "").partition("\n")[0]
    yield f"# {scene.name}: {about}"
    yield "# run:     lmp -in in.lammps      or   mpirun -np 2 lmp -in in.lammps"
    yield f"# change:  lmp -in in.lammps -var {'gravity 0.2' if gravity else 'steps 1000'}"
    yield "# units:   collision cell a0 = kBT = fluid particle mass m_f = 1"
    yield ""
    if gravity:
        what = "colloids" if isinstance(scene, Channel) else "fluid"
        yield f"variable gravity index {gravity!r} # acceleration of the {what} along x"
    yield f"variable steps index {total_steps(scene)} # of time {scene.time_step:.6g}"
    yield f"variable sample index {sample_steps(scene)} # steps between two outputs"
    for name, seed in seeds.items():
        yield f"variable {name} index {seed}"
    told = ['"total_steps": ${steps}', '"sample_steps": ${sample}']
    if gravity:
        told.append('"gravity": ${gravity}')
    yield "print '{" + ", ".join(told) + "}' file variables.json screen no # what -var made of them"
    yield ""
    yield "units lj"
    yield f"dimension {scene.dimensions}"
    yield "boundary p f p" if scene.walls else "boundary p p p"


def _channel(scene: Channel, start: Start) -> Iterator[str]:
    yield from _head(scene, scene.gravity, srd_seeds(scene, start.step))
    yield "atom_style sphere"
    yield "atom_modify first colloids"
    yield from _read(start)
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
    yield from _trajectory(start)
    yield from _run()


def _pure_fluid(scene: Poiseuille | Bulk, start: Start) -> Iterator[str]:
    gravity = scene.fluid_gravity
    yield from _head(scene, gravity, srd_seeds(scene, start.step))
    yield "atom_style atomic"
    yield "atom_modify sort 100 1.0"
    yield from _read(start)
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
    yield from _run()


def _read(start: Start) -> Iterator[str]:
    yield f"read_restart {start.checkpoint}" if start.checkpoint else "read_data state.data"


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
        f"fix profile fluid ave/chunk {_window(scene)} layers density/number vx temp "
        f"{file} fluid_profile.dat"
    )
    yield f"compute thermal fluid temp/profile 1 0 0 y {bins}"
    yield "variable fluid_temperature equal c_thermal"
    yield "variable mean_velocity_x equal vcm(all,x)"
    yield from _observables(scene, start)


def _observables(scene: Scene, start: Start) -> Iterator[str]:
    file = "append" if start.checkpoint else "file"
    yield (
        f"fix observables all ave/time {_window(scene)} v_fluid_temperature v_mean_velocity_x "
        f"{file} observables.dat"
    )
    yield "thermo $(20*v_sample)"
    yield "thermo_style custom step v_fluid_temperature v_mean_velocity_x"


def _window(scene: Scene) -> str:
    """Nevery, Nrepeat and Nfreq of an average over each sampling interval."""
    looks = fluid_looks(scene)
    return f"{sample_steps(scene) // looks} {looks} ${{sample}}"


def _trajectory(start: Start) -> Iterator[str]:
    yield (
        "dump trajectory colloids custom ${sample} trajectory.lammpsdump "
        "id type x y z vx vy vz ix iy iz"
    )
    append = " append yes" if start.checkpoint else ""
    yield f"dump_modify trajectory sort id first yes format float %.10g{append}"


def _run() -> Iterator[str]:
    yield ""
    yield "run ${steps} upto"


def _mpc_data(scene: Scene) -> Iterable[str]:
    """The data file without the fluid: the box, and the colloids if there are any."""
    state = initial_state(scene)
    mass = scene.colloid_mass if isinstance(scene, Channel) else 1.0
    yield f"# narrows: initial colloids of the scene {scene.name}\n\n"
    yield f"{scene.colloids} atoms\n1 atom types\n\n"
    yield from _box(scene)
    yield f"\nMasses\n\n1 {mass!r}\n"
    if scene.colloids:
        yield "\nAtoms # atomic\n\n"
        for i, (x, y) in enumerate(state.colloid_positions.tolist(), start=1):
            yield f"{i} 1 {x!r} {y!r} 0.0\n"
        yield "\nVelocities\n\n"
        for i, (x, y) in enumerate(state.colloid_velocities.tolist(), start=1):
            yield f"{i} {x!r} {y!r} 0.0\n"


def _box(scene: Scene) -> Iterable[str]:
    box = (*scene.box, 0.0)[:3]
    for axis, (name, size) in enumerate(zip("xyz", box, strict=True)):
        low, high = (0.0, size) if axis < scene.dimensions else (-0.5, 0.5)
        yield f"{low!r} {high!r} {name}lo {name}hi\n"


def _data(scene: Scene) -> Iterable[str]:
    """The data file: the initial state, colloids first."""
    state = initial_state(scene)
    colloids = len(state.colloid_positions)
    atoms = colloids + len(state.fluid_positions)
    yield f"# narrows: initial state of the scene {scene.name}\n\n"
    yield f"{atoms} atoms\n{2 if colloids else 1} atom types\n\n"
    yield from _box(scene)
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
