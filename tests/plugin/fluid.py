"""Fluids as fix mpc saves them, and short runs that end by saving."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lammps_inputs import Scene
from lammps_inputs.deck import script, write_deck
from lammps_inputs.engines.engine import Start
from tests.conftest import Run

Array = NDArray[np.float64]
AXES = "xyz"


@dataclass(frozen=True)
class State:
    """Fluid by particle number, colloids by id: positions and velocities (n, d)."""

    fluid_positions: Array
    fluid_velocities: Array
    colloid_positions: Array
    colloid_velocities: Array


class HasState(Protocol):
    """A `State`, or an engine that has one."""

    @property
    def fluid_positions(self) -> Array: ...
    @property
    def fluid_velocities(self) -> Array: ...
    @property
    def colloid_positions(self) -> Array: ...
    @property
    def colloid_velocities(self) -> Array: ...


def largest_difference(one: HasState, other: HasState, scene: Scene) -> float:
    """Of all coordinates and velocities, images taken as the same place."""
    differences = []
    box = scene.system.box
    for kind in ("fluid", "colloid"):
        mine, theirs = (getattr(state, f"{kind}_positions") for state in (one, other))
        assert len(mine) == len(theirs)
        if not len(mine):
            continue
        apart = box.nearest_image(mine - theirs)
        mine, theirs = (getattr(state, f"{kind}_velocities") for state in (one, other))
        differences += [abs(apart).max(), abs(mine - theirs).max()]
    return float(np.max(differences))  # NaN if there is one


def read_fluid(file: Path) -> tuple[Array, Array]:
    """Positions and velocities (N, d) of a saved fluid, by particle number."""
    content = file.read_bytes()
    dimensions, particles, _ = np.frombuffer(content[8:32], dtype="<i8")
    rows = np.frombuffer(content[32:], dtype="<f8").reshape(particles, 1 + 2 * dimensions)
    rows = rows[np.argsort(rows[:, 0])]
    np.testing.assert_array_equal(rows[:, 0], np.arange(particles))
    return rows[:, 1 : 1 + dimensions], rows[:, 1 + dimensions :]


def run_mpc(
    scene: Scene,
    collisions: int,
    folder: Path,
    command: Run,
    ranks: int = 1,
    end: str = "",
    start: Start | None = None,
) -> State:
    """The state after so many collisions of a deck for fix mpc, run by plain `lmp`."""
    folder.mkdir(exist_ok=True)
    write_deck(scene, folder, "mpc")
    if start:
        (folder / "in.lammps").write_text(script(scene, "mpc", start))
    with (folder / "in.lammps").open("a") as deck:
        deck.write("fix_modify solvent save end.fluid\n")
        columns = " ".join(("id", *AXES[: scene.system.box.dimensions]))
        velocities = " ".join(f"v{axis}" for axis in AXES[: scene.system.box.dimensions])
        deck.write(
            f"write_dump all custom end.dump {columns} {velocities} "
            "modify sort id format float %.17g\n"
        )
        deck.write(end)
    launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    steps = str(collisions * scene.system.clock.steps_per_collision)
    command(*launcher, "lmp", "-in", "in.lammps", "-var", "steps", steps, cwd=folder)
    return read_state(folder)


def read_state(folder: Path) -> State:
    """What `run_mpc` left."""
    rows = [line.split() for line in (folder / "end.dump").read_text().splitlines()[9:]]
    positions, velocities = read_fluid(folder / "end.fluid")
    dimensions = positions.shape[1]
    colloids = np.array(rows, dtype=float).reshape(-1, 1 + 2 * dimensions)[:, 1:]
    return State(positions, velocities, colloids[:, :dimensions], colloids[:, dimensions:])
