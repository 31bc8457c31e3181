"""Suspensions for fix mpc, and the same ones in numpy."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Thermostat
from srd_driver.reference import suspension as reference
from srd_driver.reference.boundaries import Boundaries
from srd_driver.reference.reflection import Spheres
from srd_driver.reference.rotation import SPHERE
from tests.conftest import Run
from tests.plugin.fluid import read_fluid

Array = NDArray[np.float64]

SEED = 7
STEPS = 5  # MD steps in a collision interval


@dataclass
class Suspension:
    """A fluid of kBT = 1 and spheres in it, with their motion in numpy.

    Attributes:
        box, periodic: lengths and whether they wrap.
        keywords: of `fix mpc`, beside where the fluid comes from.
        spheres: places of the colloids (n, d).
        radius, mass: of each.
        coupling: how they are coupled, or none.
        weight: acceleration of the colloids (d,).
        compensated: whether the fluid balances it.
        drift_interval: collisions between removals of the momentum; 0: never.
        tstat: of the fluid.
        walls: velocities of walls, see `Boundaries`.
        density: fluid particles in a cell.
        tau: time between collisions.
    """

    box: tuple[float, ...]
    periodic: tuple[bool, ...]
    spheres: tuple[tuple[float, ...], ...] = ()
    coupling: Literal["none", "entry", "nearest", "cell"] = "none"
    radius: float = 1.2
    mass: float = 20.0
    weight: tuple[float, ...] = ()
    compensated: bool = False
    drift_interval: int = 0
    tstat: Thermostat = "none"
    walls: dict[tuple[int, bool], tuple[float, ...]] = field(default_factory=dict)
    virtual: bool = True
    density: int = 5
    tau: float = 0.3

    def __post_init__(self) -> None:
        random = np.random.default_rng(11)
        d, n = len(self.box), len(self.spheres)
        self.dimensions = d
        positions = np.array(self.spheres, dtype=float).reshape(n, d).T.copy()
        velocities = random.normal(size=(d, n)) * 0.5
        spins = random.normal(size=(1 if d == 2 else 3, n))
        count = round(self.density * np.prod(self.box))
        fluid = random.uniform(size=(d, 3 * count)) * np.array(self.box)[:, None]
        separation = fluid[:, :, None] - positions[:, None]
        for axis, size in enumerate(self.box):
            if self.periodic[axis]:
                separation[axis] -= size * np.rint(separation[axis] / size)
        room = self.radius if self.coupling in ("entry", "nearest") else 0.0
        free = ((separation**2).sum(axis=0) >= room**2).all(axis=1)
        fluid = fluid[:, free][:, :count].copy()
        each = np.ones(n)
        sizes = (self.radius * each, self.mass * each, SPHERE * self.mass * self.radius**2 * each)
        self.motion = reference.Suspension(
            Boundaries(self.box, self.periodic, self.walls, self.density if self.virtual else 0),
            *(SEED, self.tau, STEPS, fluid, random.normal(size=fluid.shape)),
            Spheres(positions, velocities, spins, *sizes),
            self.coupling,
            np.array(self.weight or (0.0,) * d)[:, None],
            self.compensated,
            thermostat=self.tstat,
            drift_interval=self.drift_interval,
        )

    @property
    def arrays(self) -> dict[str, Array]:
        """The state, as `End` has it."""
        motion, spheres = self.motion, self.motion.spheres
        d, still = self.dimensions, np.zeros(self.dimensions)
        forces = np.zeros((3, 2, 3))
        for axis in range(d):
            for upper in (0, 1):
                taken = motion.boundaries.taken.get((axis, bool(upper)), still)
                forces[axis, upper, :d] = taken / motion.interval
        moved = motion.fluid_velocities - motion.fluid_velocities.mean(axis=1, keepdims=True)
        second, third, fourth = ((moved**power).mean(axis=1) for power in (2, 3, 4))
        moments = np.zeros((2, 3))
        moments[:, :d] = third / second**1.5, fourth / second**2 - 3
        return {
            "fluid_positions": motion.fluid_positions,
            "fluid_velocities": motion.fluid_velocities,
            "positions": spheres.positions,
            "velocities": spheres.velocities,
            "spins": spheres.spins,
            "moments": moments.ravel(),
            "forces_on_walls": forces.ravel(),
        }

    def write(self, folder: Path) -> None:
        """`start.fluid` and `in.lammps`, which leaves `end.fluid` and `end.dump`."""
        d, n = self.dimensions, len(self.spheres)
        spheres, fluid = self.motion.spheres, self.motion.fluid_positions
        count = fluid.shape[1]
        rows = np.vstack([np.arange(count), fluid, self.motion.fluid_velocities]).T
        header = b"mpcfluid" + np.array([d, count, 0], dtype="<i8").tobytes()
        (folder / "start.fluid").write_bytes(header + rows.astype("<f8").tobytes())
        box = " ".join(f"0 {size!r}" for size in self.box) + (" -0.5 0.5" if d == 2 else "")
        boundary = " ".join("p" if p else "f" for p in (*self.periodic, True)[:3])
        lines = [
            *("units lj", f"dimension {d}", "atom_style sphere", f"boundary {boundary}"),
            *("atom_modify sort 0 0", f"region box block {box}", "create_box 1 box"),
            *("pair_style zero 1.5", f"comm_modify cutoff {6 if n else 2.5}"),
        ]
        for i in range(n):
            v = (*spheres.velocities[:, i], 0.0)
            spin = (0.0, 0.0, *spheres.spins[:, i])[-3:]
            values = {"diameter": 2 * self.radius, "mass": self.mass}
            values |= dict(zip(("vx", "vy", "vz"), v, strict=False))
            settings = " ".join(f"{name} {float(value)!r}" for name, value in values.items())
            lines += [
                f"create_atoms 1 single {self._three(spheres.positions[:, i])}",
                f"set atom {i + 1} {settings} omega {self._three(np.array(spin))}",
            ]
        keywords = [f"density {self.density} tstat {self.tstat}"]
        weight = self._three(self.motion.acceleration[:, 0])
        if self.compensated:
            keywords.append(f"compensate {weight}")
        if self.drift_interval:
            keywords.append(f"momentum {self.drift_interval}")
        if not self.virtual:
            keywords.append("virtual no")
        for (axis, upper), velocity in self.walls.items():
            face = "xyz"[axis] + ("hi" if upper else "lo")
            keywords.append(f"wall {face} {self._three(np.array(velocity))}")
        if self.coupling == "cell":
            keywords.append("collide yes")
        elif self.coupling != "none":
            keywords.append(f"reflect 1 {self.radius!r} {self.coupling}")
        lines += [
            *("pair_coeff * *", f"timestep {self.tau / STEPS!r}", "neighbor 0.3 bin"),
            "fix motion all nve/sphere",
            f"fix weight all addforce {self._three(self.mass * self.motion.acceleration[:, 0])}",
            f"fix fluid all mpc {STEPS} {'all' if n else 'NULL'} 1 1 {SEED} load start.fluid "
            + " ".join(keywords),
            *("thermo_modify lost error", "variable steps index 1", "run ${steps}"),
            "fix_modify fluid save end.fluid",
            f'print "{" ".join(f"$(f_fluid[{k}]:%.17g)" for k in range(6, 30))}" file end.vector',
            "write_dump all custom end.dump id xu yu zu vx vy vz omegax omegay omegaz "
            "modify sort id format float %.17g",
        ]
        if d == 2:
            lines.insert(-6, "fix flat all enforce2d")
        (folder / "in.lammps").write_text("\n".join(lines) + "\n")

    def _three(self, values: Array) -> str:
        return " ".join(repr(float(v)) for v in [*values, 0.0][:3])

    def advance(self, collisions: int) -> None:
        """Move it in numpy."""
        for _ in range(collisions):
            self.motion.advance()


@dataclass(frozen=True)
class End:
    """Where fix mpc ended: arrays as those of `Suspension`."""

    fluid_positions: Array
    fluid_velocities: Array
    positions: Array
    velocities: Array
    spins: Array
    moments: Array
    forces_on_walls: Array


def run_suspension(
    suspension: Suspension, collisions: int, folder: Path, command: Run, ranks: int = 1
) -> End:
    """The same with plain `lmp`."""
    suspension.write(folder)
    launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    steps = str(collisions * STEPS)
    command(*launcher, "lmp", "-in", "in.lammps", "-var", "steps", steps, cwd=folder)
    lines = (folder / "end.dump").read_text().splitlines()[9:]
    rows = np.array([line.split() for line in lines], dtype=float).reshape(-1, 10).T
    positions, velocities = read_fluid(folder / "end.fluid")
    d = suspension.dimensions
    spins = rows[7:] if d == 3 else rows[9:]
    spheres = (rows[1 : 1 + d], rows[4 : 4 + d], spins)
    vector = np.loadtxt(folder / "end.vector")
    return End(positions.T, velocities.T, *spheres, vector[:6], vector[6:])


def differences(end: End, suspension: Suspension) -> dict[str, float]:
    """The largest of each kind, images of the fluid taken as the same place."""
    found: dict[str, Any] = {}
    for kind in vars(end):
        apart = getattr(end, kind) - suspension.arrays[kind]
        if kind.endswith("positions"):
            for axis, size in enumerate(suspension.box):
                if suspension.periodic[axis]:
                    apart[axis] -= size * np.round(apart[axis] / size)
        found[kind] = float(abs(apart).max()) if apart.size else 0.0
    return found
