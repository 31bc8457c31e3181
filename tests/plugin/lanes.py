"""Driven mixtures for tests of the thermostats: the same start for LAMMPS and the reference."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from srd_driver.reference.soft_pairs import SoftPairs
from tests.conftest import Run

Array = NDArray[np.float64]

MASSES = (1.0, 1.7)
FIELD = 2.5


@dataclass(frozen=True)
class Mixture:
    """Particles of two types of different mass and opposite field.

    Attributes:
        lengths: of the box, (D,).
        positions, velocities: (N, D); velocities relative to the flow.
        types: 1 or 2, (N,).
    """

    potential: SoftDisk | WeeksChandlerAndersen
    lengths: Array
    positions: Array
    velocities: Array
    types: NDArray[np.int64]

    @property
    def dimension(self) -> int:
        return len(self.lengths)

    @property
    def masses(self) -> Array:
        return np.array(MASSES)[self.types - 1]

    @property
    def field(self) -> Array:
        """Force on each, (N, D)."""
        force = np.zeros_like(self.positions)
        force[:, 0] = np.where(self.types == 1, FIELD, -FIELD)
        return force

    @property
    def pairs(self) -> SoftPairs:
        return SoftPairs(self.potential, self.lengths)


def mixture(dimension: int, temperature: float = 1.0) -> Mixture:
    """A crystal shaken by 0.07, with Maxwell velocities and no total momentum."""
    random = np.random.default_rng(7)
    if dimension == 2:
        potential: SoftDisk | WeeksChandlerAndersen = SoftDisk()
        cell = np.array([1.0, np.sqrt(3)]) * np.sqrt(2 / np.sqrt(3) / 0.92)
        basis = np.array([[0, 0], [0.5, 0.5]])
        counts: tuple[int, ...] = (10, 6)
    else:
        potential = WeeksChandlerAndersen()
        cell = np.full(3, (4 / 0.84) ** (1 / 3))
        basis = np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])
        counts = (3, 3, 3)
    corners = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1)
    positions = (corners.reshape(-1, 1, dimension) + 0.25 + basis).reshape(-1, dimension) * cell
    positions = positions + random.normal(0, 0.07, positions.shape)
    lengths = cell * counts
    positions = positions % lengths
    types = random.permutation(np.arange(len(positions)) % 2) + 1
    masses = np.array(MASSES)[types - 1][:, None]
    velocities = random.normal(0, np.sqrt(temperature / masses), positions.shape)
    velocities -= (masses * velocities).sum(axis=0) / masses.sum()
    return Mixture(potential, lengths, positions, velocities, types)


def write_data(start: Mixture, file: Path, rate: float = 0.0) -> None:
    """A LAMMPS data file; velocities in the frame of the laboratory."""
    x, v = np.zeros((len(start.types), 3)), np.zeros((len(start.types), 3))
    x[:, : start.dimension] = start.positions
    v[:, : start.dimension] = start.velocities
    v[:, 0] += rate * x[:, 1]
    high = float(start.lengths[2]) if start.dimension == 3 else 0.5
    lines = [
        "particles of two colours",
        "",
        f"{len(x)} atoms",
        "2 atom types",
        f"0 {float(start.lengths[0])!r} xlo xhi",
        f"0 {float(start.lengths[1])!r} ylo yhi",
        f"{0.0 if start.dimension == 3 else -0.5} {high!r} zlo zhi",
        *(["0 0 0 xy xz yz"] if rate else []),
        "",
        "Masses",
        "",
        *(f"{i} {m}" for i, m in enumerate(MASSES, 1)),
        "",
        "Atoms # atomic",
        "",
        *(
            f"{i} {t} " + " ".join(map(repr, map(float, p)))
            for i, (t, p) in enumerate(zip(start.types, x, strict=True), 1)
        ),
        "",
        "Velocities",
        "",
        *(f"{i} " + " ".join(map(repr, map(float, u))) for i, u in enumerate(v, 1)),
        "",
    ]
    file.write_text("\n".join(lines))


def pair_lines(potential: SoftDisk | WeeksChandlerAndersen) -> str:
    """The pair style of all types."""
    return (
        f"pair_style {potential.pair_style}{potential.pair_arguments(potential.cutoff, '')}\n"
        f"pair_modify {potential.pair_modify}\n{potential.pair_coeff('* *')}"
    )


def deck(start: Mixture, thermostat: str, rate: float = 0.0, dt: float = 0.001) -> str:
    """The deck up to its `run`, reading `start.data`."""
    shear = f"fix shear all deform 1 xy erate {rate} remap v units box" if rate else ""
    return f"""
units lj
dimension {start.dimension}
boundary p p p
newton on
atom_modify sort 0 0 map array
read_data start.data
{pair_lines(start.potential)}
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
timestep {dt}
group plus type 1
group minus type 2
{shear}
fix pull plus addforce {FIELD} 0 0
fix push minus addforce -{FIELD} 0 0
fix thermostat all {thermostat}
compute configurations all temp/configurational
thermo_style custom step temp pe press c_configurations f_thermostat
"""


DUMP = """
dump state all custom {steps} state.{steps} id x y z vx vy vz
dump_modify state sort id format float %.17g first no
"""


def read_state(file: Path, dimension: int) -> tuple[Array, Array, float]:
    """Positions, velocities and tilt of the last frame of a dump."""
    frame = file.read_text().split("ITEM: TIMESTEP")[-1].splitlines()
    header = next(i for i, line in enumerate(frame) if line.startswith("ITEM: ATOMS"))
    bounds = frame[header - 3].split()
    tilt = float(bounds[2]) if len(bounds) == 3 else 0.0
    rows = np.array([line.split() for line in frame[header + 1 :]], dtype=float)
    return rows[:, 1 : 1 + dimension], rows[:, 4 : 4 + dimension], tilt


def run_lammps(
    start: Mixture,
    thermostat: str,
    steps: int,
    folder: Path,
    command: Run,
    ranks: int = 1,
    rate: float = 0.0,
    dt: float = 0.001,
) -> tuple[Array, Array, float]:
    """Positions, velocities relative to the flow, and tilt after some steps."""
    folder.mkdir(exist_ok=True)
    write_data(start, folder / "start.data", rate)
    text = deck(start, thermostat, rate, dt) + DUMP.format(steps=steps) + f"run {steps}\n"
    (folder / "in.lammps").write_text(text)
    words: list[Any] = ["lmp", "-in", "in.lammps", "-screen", "none"]
    command(*(["mpirun", "-np", str(ranks), *words] if ranks > 1 else words), cwd=folder)
    positions, velocities, tilt = read_state(folder / f"state.{steps}", start.dimension)
    velocities[:, 0] -= rate * positions[:, 1]
    return positions, velocities, tilt


def periodic_difference(one: Array, other: Array, lengths: Array, tilt: float) -> Array:
    """Nearest-image difference of positions, (N, D)."""
    difference = one - other
    difference[:, 0] -= tilt * np.round(difference[:, 1] / lengths[1])
    return np.asarray(difference - lengths * np.round(difference / lengths))
