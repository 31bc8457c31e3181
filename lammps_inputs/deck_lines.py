"""What the decks of all engines share, line by line, and where a deck starts."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from lammps_inputs import Channel, Scene


@dataclass(frozen=True)
class Start:
    """Where a deck starts: from `state.data` at step 0, or from a checkpoint at its step."""

    step: int = 0
    checkpoint: str | None = None


def head(scene: Scene, gravity: float | None, seeds: dict[str, int]) -> Iterator[str]:
    """What the deck is, its variables, and the kind of box."""
    about = (type(scene).__doc__ or "").partition("\n")[0]
    yield f"# {scene.name}: {about}"
    yield "# run:     lmp -in in.lammps      or   mpirun -np 2 lmp -in in.lammps"
    yield f"# change:  lmp -in in.lammps -var {'gravity 0.2' if gravity else 'steps 1000'}"
    yield "# units:   collision cell a0 = kBT = fluid particle mass m_f = 1"
    yield ""
    if gravity:
        what = "colloids" if isinstance(scene, Channel) else "fluid"
        yield f"variable gravity index {gravity!r} # acceleration of the {what} along x"
    yield f"variable steps index {scene.total_steps} # of time {scene.time_step:.6g}"
    yield f"variable sample index {scene.sample_steps} # steps between two outputs"
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


def read(start: Start) -> Iterator[str]:
    """The state the deck starts from."""
    yield f"read_restart {start.checkpoint}" if start.checkpoint else "read_data state.data"


def observables(scene: Scene, start: Start) -> Iterator[str]:
    """The averages of each sampling interval, from the two variables, and the log."""
    file = "append" if start.checkpoint else "file"
    yield (
        f"fix observables all ave/time {window(scene)} v_fluid_temperature v_mean_velocity_x "
        f"{file} observables.dat"
    )
    yield "thermo $(20*v_sample)"
    yield "thermo_style custom step v_fluid_temperature v_mean_velocity_x"


def window(scene: Scene) -> str:
    """Nevery, Nrepeat and Nfreq of an average over each sampling interval."""
    looks = scene.fluid_looks
    return f"{scene.sample_steps // looks} {looks} ${{sample}}"


def trajectory(start: Start) -> Iterator[str]:
    """The colloids, at every sampled step."""
    yield (
        "dump trajectory colloids custom ${sample} trajectory.lammpsdump "
        "id type x y z vx vy vz ix iy iz"
    )
    append = " append yes" if start.checkpoint else ""
    yield f"dump_modify trajectory sort id first yes format float %.10g{append}"


def run() -> Iterator[str]:
    """The last command of every deck."""
    yield ""
    yield "run ${steps} upto"


def box(scene: Scene) -> Iterable[str]:
    """The box of a data file."""
    sizes = (*scene.box, 0.0)[:3]
    for axis, (name, size) in enumerate(zip("xyz", sizes, strict=True)):
        low, high = (0.0, size) if axis < scene.dimensions else (-0.5, 0.5)
        yield f"{low!r} {high!r} {name}lo {name}hi\n"
