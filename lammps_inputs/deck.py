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
from lammps_inputs.initial_state import initial_state
from lammps_inputs.poiseuille import Poiseuille
from lammps_inputs.scene import SceneError

Scene = Channel | Poiseuille | Bulk
Engine = Literal["srd", "reference"]

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
        "seeds": {"seed": scene.seed, **(srd_seeds(scene) if engine == "srd" else {})},
    }


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
    if engine == "srd":
        (directory / "in.lammps").write_text(script(scene), encoding="utf-8")
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            file.writelines(_data(scene))
        if isinstance(scene, Channel) and scene.wall_strength > 0:
            table = scene.colloid_wall.table_text()
            (directory / "wall.table").write_text(table, encoding="utf-8")


def script(scene: Scene, start: Start | None = None) -> str:
    """The input script; its last command is the `run`."""
    start = start or Start()
    parts = _channel(scene, start) if isinstance(scene, Channel) else _pure_fluid(scene, start)
    return "\n".join(parts) + "\n"


def _head(scene: Scene, start: Start, gravity: float | None) -> Iterator[str]:
    seeds = srd_seeds(scene, start.step)
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
    yield f"variable seed_collision index {seeds['seed_collision']}"
    yield f"variable seed_shift index {seeds['seed_shift']}"
    told = ['"total_steps": ${steps}', '"sample_steps": ${sample}']
    if gravity:
        told.append('"gravity": ${gravity}')
    yield "print '{" + ", ".join(told) + "}' file variables.json screen no # what -var made of them"
    yield ""
    yield "units lj"
    yield f"dimension {scene.dimensions}"
    yield "boundary p f p" if scene.walls else "boundary p p p"


def _channel(scene: Channel, start: Start) -> Iterator[str]:
    yield from _head(scene, start, scene.gravity)
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
    yield (
        "dump trajectory colloids custom ${sample} trajectory.lammpsdump "
        "id type x y z vx vy vz ix iy iz"
    )
    append = " append yes" if start.checkpoint else ""
    yield f"dump_modify trajectory sort id first yes format float %.10g{append}"
    yield from _run()


def _pure_fluid(scene: Poiseuille | Bulk, start: Start) -> Iterator[str]:
    gravity = scene.fluid_gravity
    yield from _head(scene, start, gravity)
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
    looks = fluid_looks(scene)
    window = f"{sample_steps(scene) // looks} {looks} ${{sample}}"
    file = "append" if start.checkpoint else "file"
    yield ""
    yield "# output: fluid by half-cell bins along y, averaged over each sampling interval"
    yield f"compute layers fluid chunk/atom bin/1d y lower {scene.width / bins!r} units box"
    yield (
        f"fix profile fluid ave/chunk {window} layers density/number vx temp "
        f"{file} fluid_profile.dat"
    )
    yield f"compute thermal fluid temp/profile 1 0 0 y {bins}"
    yield "variable fluid_temperature equal c_thermal"
    yield "variable mean_velocity_x equal vcm(all,x)"
    yield (
        f"fix observables all ave/time {window} v_fluid_temperature v_mean_velocity_x "
        f"{file} observables.dat"
    )
    yield "thermo $(20*v_sample)"
    yield "thermo_style custom step v_fluid_temperature v_mean_velocity_x"


def _run() -> Iterator[str]:
    yield ""
    yield "run ${steps} upto"


def _data(scene: Scene) -> Iterable[str]:
    """The data file: the initial state, colloids first."""
    state = initial_state(scene)
    colloids = len(state.colloid_positions)
    atoms = colloids + len(state.fluid_positions)
    box = (*scene.box, 0.0)[:3]
    low_high = [
        (0.0, size) if axis < scene.dimensions else (-0.5, 0.5) for axis, size in enumerate(box)
    ]
    yield f"# narrows: initial state of the scene {scene.name}\n\n"
    yield f"{atoms} atoms\n{2 if colloids else 1} atom types\n\n"
    for axis, (low, high) in zip("xyz", low_high, strict=True):
        yield f"{low!r} {high!r} {axis}lo {axis}hi\n"
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
