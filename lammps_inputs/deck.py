"""LAMMPS decks: a folder that plain `lmp -in in.lammps` runs, and `-var name value` changes.

A deck contains only what its system needs. The run directory it fills is described in
docs/run-directory.md; the driver runs the very same lines.
"""

from collections.abc import Iterator
from pathlib import Path

from lammps_inputs.engines import engine_named, lammps_engine_named
from lammps_inputs.engines.engine import LammpsEngine, Start
from lammps_inputs.engines.lammps import table, trajectory
from lammps_inputs.initial_state import initial_state
from lammps_inputs.limits import memory_problems
from lammps_inputs.scene import Scene, SceneError
from lammps_inputs.system import Continuation, System


def check_engine(scene: Scene, engine: str) -> None:
    """Refuse what the engine of that name cannot do, or this machine's memory cannot hold.

    Raises:
        SceneError: naming the field or part, its value and what the engine allows.
    """
    problems = [*memory_problems(scene.system), *engine_named(engine).problems(scene.system)]
    if problems:
        raise SceneError(problems)


def warnings(scene: Scene, engine: str) -> Iterator[str]:
    """What will be inaccurate, one line each: field, value and reason."""
    yield from scene.warnings()
    yield from engine_named(engine).warnings(scene.system)


def write_deck(scene: Scene, directory: Path, engine: str) -> None:
    """Write the input script and what it reads into a folder.

    Raises:
        SceneError: when the engine cannot run the scene, or writes no decks, or the run that it
            starts from is not there.
    """
    check_engine(scene, engine)
    placement = scene.system.placement
    if isinstance(placement, Continuation):
        problems = list(placement.problems(scene.system.box, scene.system.species))
        if problems:
            raise SceneError([f"start of {scene.name}: {problem}" for problem in problems])
    (directory / "in.lammps").write_text(script(scene, engine), encoding="utf-8")
    state = initial_state(scene.system, scene.seed)
    lammps_engine_named(engine).write(scene.system, state, scene.name, directory)


def script(scene: Scene, engine: str, start: Start | None = None) -> str:
    """The input script; its last command is the `run`.

    Raises:
        SceneError: when the engine writes no decks.
    """
    return "\n".join(_lines(scene, lammps_engine_named(engine), start or Start())) + "\n"


def has_deck(engine: str) -> bool:
    """Whether LAMMPS runs the engine of that name."""
    return isinstance(engine_named(engine), LammpsEngine)


def _lines(scene: Scene, engine: LammpsEngine, start: Start) -> Iterator[str]:
    """The order of every deck."""
    system = scene.system
    yield from _title(scene)
    yield from _variables(system, engine.seeds(scene.seed, start.step))
    yield ""
    yield "units lj"
    yield f"dimension {system.box.dimensions}"
    yield f"boundary {' '.join('p' if way else 'f' for way in (*system.box.periodic, True)[:3])}"
    yield from engine.atoms(system, start)
    yield ""
    yield from engine.interactions(system)
    yield f"timestep {system.clock.time_step!r}"
    yield from engine.preparation(system, start)
    yield from engine.motion(system)
    yield ""
    if system.solvent:
        yield from engine.solvent(system, start)
        yield ""
    yield from engine.averages(system, start)
    for output in system.outputs:
        if output.kind == "table":
            yield from table(output, system, start)
    for output in system.outputs:
        if output.kind == "trajectory":
            yield from trajectory(output, system, start)
    yield ""
    renewal = " ".join(f'"{command}"' for command in engine.renewal(system))
    yield "run ${steps} upto" + (f" post no every ${{sample}} {renewal}" if renewal else "")


def _title(scene: Scene) -> Iterator[str]:
    about = (type(scene).__doc__ or "").partition("\n")[0]
    change = next((f"{drive.variable} 0.2" for drive in scene.system.drives), "steps 1000")
    yield f"# {scene.name}: {about}"
    yield "# run:     lmp -in in.lammps      or   mpirun -np 2 lmp -in in.lammps"
    yield f"# change:  lmp -in in.lammps -var {change}"
    solvent = scene.system.solvent
    cell = "collision cell a0" if not solvent or solvent.cell == 1 else "a0"
    fluid = f"{cell} = kBT = fluid particle mass m_f = 1"
    yield f"# units:   {fluid if solvent else 'a0 = kBT = m_f = 1'}"
    yield ""


def _variables(system: System, seeds: dict[str, int]) -> Iterator[str]:
    """What `-var` changes, checked, and a file that tells what it made of them."""
    clock = system.clock
    for variable, drives in system.drive_variables().items():
        pulled = ", ".join(f"{each.target} along {_direction(each.direction)}" for each in drives)
        yield f"variable {variable} index {drives[0].magnitude!r} # acceleration of the {pulled}"
    yield f"variable steps index {clock.total_steps} # of time {clock.time_step:.6g}"
    yield f"variable sample index {clock.sample_steps} # steps between two outputs"
    for name, seed in seeds.items():
        yield f"variable {name} index {seed}"
    yield (
        f'if "${{sample}} < {2 * clock.look_steps} || $(v_sample%{clock.look_steps}) != 0" then '
        f"\"print 'ERROR: sample must be a multiple of {clock.look_steps}, at least twice that'\" "
        '"quit 1"'
    )
    told = ['"total_steps": ${steps}', '"sample_steps": ${sample}']
    told += [f'"{variable}": ${{{variable}}}' for variable in system.drive_variables()]
    yield "print '{" + ", ".join(told) + "}' file variables.json screen no # what -var made of them"


def _direction(direction: tuple[float, float, float]) -> str:
    axes = [axis for axis, part in zip("xyz", direction, strict=True) if part]
    if len(axes) == 1 and abs(sum(direction)) == 1:
        return axes[0] if sum(direction) > 0 else f"-{axes[0]}"
    return f"({', '.join(f'{part:g}' for part in direction)})"
