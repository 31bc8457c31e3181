"""Suspensions for fix mpc, and the same ones in numpy."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from srd_driver.reference import cell_coupling, thermostats
from srd_driver.reference.boundaries import Boundaries, stream, virtual_particles
from srd_driver.reference.collision import Cells, collide, grid_shape, grid_shift
from srd_driver.reference.counter_random import CounterRandom
from srd_driver.reference.reflection import Placement, Spheres, reflect
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
    coupling: str = "none"
    radius: float = 1.2
    mass: float = 20.0
    weight: tuple[float, ...] = ()
    compensated: bool = False
    drift_interval: int = 0
    tstat: str = "none"
    walls: dict[tuple[int, bool], tuple[float, ...]] = field(default_factory=dict)
    virtual: bool = True
    density: int = 5
    tau: float = 0.3

    def __post_init__(self) -> None:
        random = np.random.default_rng(11)
        d, n = len(self.box), len(self.spheres)
        self.dimensions = d
        self.positions = np.array(self.spheres, dtype=float).reshape(n, d).T.copy()
        self.velocities = random.normal(size=(d, n)) * 0.5
        self.spins = random.normal(size=(1 if d == 2 else 3, n))
        self.acceleration = np.array(self.weight or (0.0,) * d)[:, None]
        count = round(self.density * np.prod(self.box))
        fluid = random.uniform(size=(d, 3 * count)) * np.array(self.box)[:, None]
        separation = fluid[:, :, None] - self.positions[:, None]
        for axis, size in enumerate(self.box):
            if self.periodic[axis]:
                separation[axis] -= size * np.rint(separation[axis] / size)
        room = self.radius if self.coupling in ("entry", "nearest") else 0.0
        free = ((separation**2).sum(axis=0) >= room**2).all(axis=1)
        self.fluid_positions = fluid[:, free][:, :count].copy()
        self.fluid_velocities = random.normal(size=self.fluid_positions.shape)
        self.boundaries = Boundaries(
            self.box, self.periodic, self.walls, self.density if self.virtual else 0
        )
        self.field = np.zeros((d, 1))
        if self.compensated:
            self.field = -self.acceleration * self.mass * n / self.fluid_positions.shape[1]

    def write(self, folder: Path) -> None:
        """`start.fluid` and `in.lammps`, which leaves `end.fluid` and `end.dump`."""
        d, n = self.dimensions, len(self.spheres)
        count = self.fluid_positions.shape[1]
        rows = np.vstack([np.arange(count), self.fluid_positions, self.fluid_velocities]).T
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
            v = (*self.velocities[:, i], 0.0)
            spin = (0.0, 0.0, *self.spins[:, i])[-3:]
            values = {"diameter": 2 * self.radius, "mass": self.mass}
            values |= dict(zip(("vx", "vy", "vz"), v, strict=False))
            settings = " ".join(f"{name} {float(value)!r}" for name, value in values.items())
            lines += [
                f"create_atoms 1 single {self._three(self.positions[:, i])}",
                f"set atom {i + 1} {settings} omega {self._three(np.array(spin))}",
            ]
        keywords = [f"density {self.density} tstat {self.tstat}"]
        weight = self._three(self.acceleration[:, 0])
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
            f"fix weight all addforce {self._three(self.mass * self.acceleration[:, 0])}",
            f"fix fluid all mpc {STEPS} {'all' if n else 'NULL'} 1 1 {SEED} load start.fluid "
            + " ".join(keywords),
            *("thermo_modify lost error", "variable steps index 1", "run ${steps}"),
            "fix_modify fluid save end.fluid",
            "write_dump all custom end.dump id xu yu zu vx vy vz omegax omegay omegaz "
            "modify sort id format float %.17g",
        ]
        if d == 2:
            lines.insert(-5, "fix flat all enforce2d")
        (folder / "in.lammps").write_text("\n".join(lines) + "\n")

    def _three(self, values: Array) -> str:
        return " ".join(repr(float(v)) for v in [*values, 0.0][:3])

    def advance(self, collisions: int) -> None:
        """Move it in numpy."""
        time = self.tau / STEPS
        for collision in range(collisions):
            fluid = (self.fluid_positions, self.fluid_velocities)
            stream(*fluid, self.field, self.tau, self.boundaries)
            self.boundaries.wrap(self.fluid_positions)
            for _ in range(STEPS):
                self.velocities += 0.5 * time * self.acceleration
                self.positions += time * self.velocities
                self.velocities += 0.5 * time * self.acceleration
            random = CounterRandom(SEED, collision)
            if self.coupling in ("entry", "nearest"):
                self._reflect(random)
            self._collide(random)
            if self.drift_interval and (collision + 1) % self.drift_interval == 0:
                mass = self.fluid_positions.shape[1] + self.mass * len(self.spheres)
                drift = self.momentum()[:, None] / mass
                self.fluid_velocities -= drift
                self.velocities -= drift

    def momentum(self) -> Array:
        """Of everything (d,)."""
        total: Array = self.fluid_velocities.sum(axis=1) + self.mass * self.velocities.sum(axis=1)
        return total

    def _reflect(self, random: CounterRandom) -> None:
        each = np.ones(len(self.spheres))
        inertia = SPHERE * self.mass * self.radius**2
        spheres = Spheres(
            *(self.positions, self.velocities, self.spins),
            *(self.radius * each, self.mass * each, inertia * each),
        )
        fluid = (self.fluid_positions, self.fluid_velocities)
        placement: Placement = "entry" if self.coupling == "entry" else "nearest"
        momentum, angular = reflect(
            *fluid, spheres, placement, self.tau, 1.0, self.field, self.boundaries, random
        )
        self.velocities += momentum / self.mass
        self.spins += angular / inertia

    def _collide(self, random: CounterRandom) -> None:
        positions, velocities = self.fluid_positions, self.fluid_velocities
        masses = np.ones(positions.shape[1])
        if self.coupling == "cell":
            wrapped = self.positions.copy()
            self.boundaries.wrap(wrapped)
            positions = np.hstack([positions, wrapped])
            velocities = np.hstack([velocities, self.velocities])
            masses = np.concatenate([masses, np.full(len(self.spheres), self.mass)])
        shift = grid_shift(random, self.dimensions)
        shape = grid_shape(self.box, self.periodic)
        cells = Cells.sort(positions, shift, shape, self.periodic)
        of_fluid = cells.numbers[: self.fluid_positions.shape[1]]
        fluid = np.bincount(of_fluid, minlength=cells.count).astype(float)
        filled = virtual_particles(self.boundaries, cells, shift, fluid, 1.0, random)
        mean = cell_coupling.mean_velocity(velocities, masses, cells, *filled)
        collide(velocities, cells, mean, 90, "coordinate_axes", random)
        if self.tstat == "monte_carlo":
            cell_coupling.monte_carlo(velocities, masses, cells, 1.0, random)
        elif self.tstat == "layer":
            thermostats.layer(velocities, cells)
        if self.coupling == "cell":
            count = self.fluid_positions.shape[1]
            self.fluid_velocities[:] = velocities[:, :count]
            self.velocities[:] = velocities[:, count:]


@dataclass(frozen=True)
class End:
    """Where fix mpc ended: arrays as those of `Suspension`."""

    fluid_positions: Array
    fluid_velocities: Array
    positions: Array
    velocities: Array
    spins: Array


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
    return End(positions.T, velocities.T, rows[1 : 1 + d], rows[4 : 4 + d], spins)


def differences(end: End, suspension: Suspension) -> dict[str, float]:
    """The largest of each kind, images of the fluid taken as the same place."""
    found: dict[str, Any] = {}
    for kind in vars(end):
        apart = getattr(end, kind) - getattr(suspension, kind)
        if kind.endswith("positions"):
            for axis, size in enumerate(suspension.box):
                if suspension.periodic[axis]:
                    apart[axis] -= size * np.round(apart[axis] / size)
        found[kind] = float(abs(apart).max()) if apart.size else 0.0
    return found
