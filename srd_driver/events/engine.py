"""Hard spheres by events: set up, advance, look at, save and load."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lammps_inputs.close_packing import close_packing, sphere_volume
from lammps_inputs.system import Array
from srd_driver.events import kernel, profiles
from srd_driver.events.errors import EventError
from srd_driver.events.initial import thermal_velocities
from srd_driver.events.profiles import Profile
from srd_driver.events.state import (
    COLLISIONS,
    CROSSINGS,
    LISTED,
    REPREDICTED,
    ROW,
    SPEED_BINS,
    VIRIAL,
    WALL_HITS,
    WALL_MOMENTUM,
    Colors,
    Spheres,
)

_BUCKETS = 4  # for each particle: a ring of 4 mean times to the next event
_BINS = 50  # of the profiles, for each diameter
_CELLS = 4  # on a periodic axis, so that images in neighbouring cells are the nearest ones
_OVERLAP = 1e-9
_LARGE = 20_000  # particles, from which on the state does not fit a core's own cache
_LINE = 64  # bytes of a cache line
_CELL_OCCUPATION = 0.5  # of dilute systems; in dense ones cells are a diameter wide


@dataclass(frozen=True)
class WallReactions:
    """Colour reactions at the two walls of an axis: A to B at the lower, B to A at the upper.

    Attributes:
        probabilities: p_r, each in (0, 1].
        axis: 0, 1 or 2.
    """

    probabilities: Sequence[float]
    axis: int = 2


@dataclass(frozen=True)
class PairReactions:
    """Colour reactions about central particles: A to B at contact, B to A on entering R_cut.

    Attributes:
        probabilities: p_r, each in (0, 1].
        centers: numbers of the central particles, each with colours of its own.
        cutoff: R_cut; below half the shortest box length.
    """

    probabilities: Sequence[float]
    centers: Sequence[int]
    cutoff: float


class HardSpheres:
    """Equal hard spheres (or disks) of mass 1 between walls or in a periodic box.

    The trajectory does not depend on how it is cut into calls of `advance`, nor on what is looked
    at in between, nor on being saved and loaded, to the last bit.

    Args:
        positions: of the centres, (N, d), d = 2 or 3.
        velocities: (N, d).
        lengths: of the box, (d,); from wall to wall where there are walls.
        walls: axes that end at hard walls.
        diameter: of the spheres.
        reactions: of colours, if any.
        seed: of the lots of the colours.

    Raises:
        EventError: for a box that is too small, spheres that overlap or lie outside of it, or
            reactions that have no place.
    """

    def __init__(
        self,
        positions: ArrayLike,
        velocities: ArrayLike,
        lengths: ArrayLike,
        walls: Sequence[int] = (),
        *,
        diameter: float = 1.0,
        reactions: WallReactions | PairReactions | None = None,
        seed: int = 0,
    ) -> None:
        box = np.asarray(lengths, dtype=float)
        start = np.asarray(positions, dtype=float)
        speed = np.asarray(velocities, dtype=float)
        self.dimensions = len(box)
        self.walls = tuple(sorted(walls))
        _check(start, speed, box, set(walls), diameter)
        spheres = _spheres(start, speed, box, set(walls), diameter)
        kernel.fill_cells(spheres)
        i, j, distance = kernel.nearest(spheres)
        if distance < diameter * (1 - _OVERLAP):
            raise EventError(f"particles {i} and {j} overlap: they are {distance:.6g} apart")
        ahead = kernel.predict_all(spheres)
        buckets = 1 << math.ceil(math.log2(_BUCKETS * len(start)))
        self._spheres = spheres._replace(
            inverse_width=len(start) / ahead if 0 < ahead < math.inf else 1.0,
            bucket=np.full(buckets, -1, dtype=np.int32),
        )
        kernel.file_all(self._spheres)
        self._colors = _colors(reactions, self._spheres, seed)
        self.set_colors(self._colors.chance)

    @classmethod
    def fluid(
        cls,
        count: int,
        lengths: ArrayLike,
        walls: Sequence[int] = (),
        *,
        diameter: float = 1.0,
        temperature: float = 1.0,
        reactions: WallReactions | PairReactions | None = None,
        seed: int = 0,
    ) -> Self:
        """So many spheres at a temperature, on a lattice with vacancies that is yet to melt.

        Args:
            count: N.
            temperature: kBT; the energy is exact, and no momentum is along periodic axes.
            lengths, walls, diameter, reactions, seed: as of the class.
        """
        if count < 1:
            raise EventError(f"count: {count}; at least 1 sphere is needed")
        if not temperature > 0:
            raise EventError(f"temperature: {temperature:g}; it must be positive")
        box = np.asarray(lengths, dtype=float)
        axes = tuple(walls)
        try:
            positions = close_packing(count, box, axes, diameter, seed)
        except ValueError as error:
            raise EventError(str(error)) from None
        velocities = thermal_velocities(count, len(box), axes, temperature, seed)
        return cls(
            positions, velocities, box, axes, diameter=diameter, reactions=reactions, seed=seed
        )

    @property
    def time(self) -> float:
        """Simulated time."""
        return float(self._spheres.clock[0])

    @property
    def lengths(self) -> Array:
        """Of the box, (d,)."""
        return self._spheres.lengths[: self.dimensions]

    @property
    def positions(self) -> Array:
        """Of the centres in the box, (N, d): a copy."""
        s = self._spheres
        since = (s.clock[0] - s.body[:, 6])[:, None]
        now: Array = s.body[:, :3] + s.body[:, 3:6] * since
        return now[:, : self.dimensions]

    @property
    def images(self) -> NDArray[np.int32]:
        """Box lengths to add to the positions, (N, d): a copy."""
        return self._spheres.image[:, : self.dimensions].copy()

    @property
    def velocities(self) -> Array:
        """(N, d): a copy."""
        return self._spheres.body[:, 3 : 3 + self.dimensions].copy()

    @property
    def labels(self) -> NDArray[np.uint8]:
        """1 for A, 0 for B, by reference, particle and probability (M, N, K), live."""
        return self._colors.label

    @property
    def chances(self) -> Array:
        """q, the probability to be A given the trajectory, (M, N, K), live."""
        return self._colors.chance

    @property
    def collisions(self) -> int:
        """Collisions between spheres so far."""
        return int(self._spheres.tally[COLLISIONS])

    @property
    def wall_hits(self) -> int:
        """Collisions with walls so far."""
        return int(self._spheres.tally[WALL_HITS])

    @property
    def overheads(self) -> dict[str, float]:
        """Cell crossings and renewed predictions for each collision."""
        total = max(self.collisions, 1)
        tally = self._spheres.tally
        return {"crossings": tally[CROSSINGS] / total, "repredicted": tally[REPREDICTED] / total}

    @property
    def virial(self) -> float:
        """Sum over collisions of -r.u = sigma |normal velocity|: Z = 1 + virial / (d N kBT t)."""
        return float(self._spheres.sums[VIRIAL])

    @property
    def wall_momentum(self) -> Array:
        """Momentum given to the lower and the upper wall of each axis, (d, 2)."""
        given: Array = self._spheres.sums[WALL_MOMENTUM:].reshape(3, 2)
        return given[: self.dimensions].copy()

    def nearest(self) -> float:
        """Smallest distance of two spheres, if it is below a cell's edge."""
        return float(kernel.nearest(self._spheres)[2])

    def energy(self) -> float:
        """Kinetic energy, conserved."""
        return 0.5 * float(np.sum(self._spheres.body[:, 3:6] ** 2))

    def packing_fraction(self) -> float:
        """Volume of the spheres over that of the box, from wall to wall."""
        volume = float(np.prod(self.lengths))
        return (
            len(self._spheres.body)
            * sphere_volume(self._spheres.diameter, self.dimensions)
            / volume
        )

    def advance(self, time: float) -> None:
        """Simulate so much more time, which may be cut anywhere: see the class."""
        kernel.advance(self._spheres, self._colors, self.time + time)

    def advance_to(self, time: float) -> None:
        """Simulate up to a time."""
        kernel.advance(self._spheres, self._colors, time)

    def set_colors(self, chance: ArrayLike) -> None:
        """Start the colours anew from q, broadcast to (M, N, K); labels are drawn from it."""
        c = self._colors
        c.chance[:] = chance
        lots = np.random.default_rng([int(c.seed), 2]).random(c.label.shape)
        c.label[:] = lots < c.chance

    def sample(self) -> None:
        """Add the present state to the profile."""
        profiles.sample(self._spheres, self._colors)

    def take_profile(self) -> Profile:
        """What was sampled since the last call; the sums begin anew."""
        c = self._colors
        profile = Profile(
            time=self.time - float(c.since[0]),
            samples=int(c.samples[0]),
            references=max(len(c.center), 1),
            positions=c.low + c.width * np.arange(0.5, len(c.number)),
            width=c.width,
            number=c.number.copy(),
            composition=c.composition.copy(),
            current=c.current.copy(),
            reactions=c.reactions.copy(),
            hits=c.hits.copy(),
            speeds=c.speeds.copy(),
        )
        sums = (c.samples, c.number, c.composition, c.current, c.reactions, c.hits, c.speeds)
        for array in sums:
            array[:] = 0
        c.since[0] = self.time
        return profile

    def save(self, file: str | PathLike[str]) -> None:
        """Write the state as npz; `load` continues from it bit for bit."""
        fields = {f"s_{name}": value for name, value in self._spheres._asdict().items()}
        fields |= {f"c_{name}": value for name, value in self._colors._asdict().items()}
        with open(file, "wb") as output:
            np.savez(output, dimensions=self.dimensions, **fields)

    @classmethod
    def load(cls, file: str | PathLike[str]) -> Self:
        """The engine that `save` wrote.

        Raises:
            EventError: for a file of another version.
        """
        engine = cls.__new__(cls)
        with np.load(file) as saved:
            wanted = {"dimensions"}
            wanted |= {f"s_{name}" for name in Spheres._fields}
            wanted |= {f"c_{name}" for name in Colors._fields}
            if missing := sorted(wanted - set(saved.files)):
                raise EventError(f"{file}: of another version of narrows: it has no {missing[0]}")
            engine.dimensions = int(saved["dimensions"])
            engine._spheres = _aligned(
                Spheres(*(_loaded(saved[f"s_{n}"]) for n in Spheres._fields))
            )
            engine._colors = Colors(*(_loaded(saved[f"c_{n}"]) for n in Colors._fields))
        walls = engine._spheres.wall[: engine.dimensions]
        engine.walls = tuple(int(axis) for axis in np.flatnonzero(walls))
        return engine


def _loaded(array: NDArray[Any]) -> Any:
    return array if array.ndim else array[()] if array.dtype == np.uint64 else array.item()


def _check(start: Array, velocities: Array, box: Array, walls: set[int], diameter: float) -> None:
    dimensions = len(box)
    if dimensions not in (2, 3):
        raise EventError(f"lengths: {dimensions} of them; a box has 2 or 3")
    if not 0 < diameter < math.inf:
        raise EventError(f"diameter: {diameter:g}; it must be positive")
    if not walls <= set(range(dimensions)):
        raise EventError(f"walls: {sorted(walls)}; the axes are 0 to {dimensions - 1}")
    if len(start) == 0 or start.shape != velocities.shape or start.shape[1] != dimensions:
        raise EventError(
            f"positions {start.shape}, velocities {velocities.shape}: both must be "
            f"(N, {dimensions}) with N at least 1"
        )
    if not (np.isfinite(start).all() and np.isfinite(velocities).all()):
        raise EventError("positions and velocities: not all are finite numbers")
    for axis in range(dimensions):
        if axis in walls:
            if not box[axis] > diameter:
                raise EventError(
                    f"lengths[{axis}]: {box[axis]:g}; between walls it must exceed the diameter, "
                    f"{diameter:g}"
                )
            outside = np.abs(start[:, axis] - box[axis] / 2) > (box[axis] - diameter) / 2 + 1e-9
            if outside.any():
                i = int(outside.argmax())
                raise EventError(f"particle {i} is in a wall: {start[i].tolist()}")
        elif not box[axis] >= _CELLS * diameter:
            raise EventError(
                f"lengths[{axis}]: {box[axis]:g}; a periodic axis must have at least "
                f"{_CELLS} diameters, {_CELLS * diameter:g}"
            )


def _spheres(
    start: Array, velocities: Array, box: Array, walls: set[int], diameter: float
) -> Spheres:
    """The arrays with empty cells and an empty queue."""
    count, dimensions = start.shape
    body = np.zeros((count, 8))
    body[:, :dimensions] = start
    body[:, 3 : 3 + dimensions] = velocities
    lengths, low, size, inverse = np.zeros((4, 3))
    cells = np.ones(3, dtype=np.int32)
    wall = np.ones(3, dtype=np.int32)
    extent = np.array([box[a] - diameter if a in walls else box[a] for a in range(dimensions)])
    edge = max(
        diameter * (1 + 1e-9),
        (_CELL_OCCUPATION * float(np.prod(extent)) / count) ** (1 / dimensions),
    )
    for axis in range(dimensions):
        lengths[axis] = box[axis]
        wall[axis] = axis in walls
        low[axis] = diameter / 2 if axis in walls else 0.0
        fewest = 1 if axis in walls else _CELLS
        cells[axis] = max(int(extent[axis] / edge), fewest)
        size[axis] = extent[axis] / cells[axis]
        if axis not in walls:
            inverse[axis] = 1 / box[axis]
            body[:, axis] %= box[axis]
    longest = int(cells.max())
    step = np.zeros((3, longest, 3), dtype=np.int32)
    ways = np.zeros((3, longest), dtype=np.int32)
    stride = 1
    for axis in range(3):
        for place in range(cells[axis]):
            for offset in (-1, 0, 1):
                target = place + offset
                if wall[axis] and not 0 <= target < cells[axis]:
                    continue
                step[axis, place, ways[axis, place]] = (target % cells[axis] - place) * stride
                ways[axis, place] += 1
        stride *= int(cells[axis])
    # the spheres of a cell lie in a box a diameter wider, where none pack denser than crystals do
    crystal = 2 / math.sqrt(3) if dimensions == 2 else math.sqrt(2)
    capacity = int(crystal * float(np.prod(size[:dimensions] / diameter + 1)))
    room = 27 * capacity + LISTED + ROW
    spheres = Spheres(
        diameter=float(diameter),
        lengths=lengths,
        low=low,
        size=size,
        cells=cells,
        wall=wall,
        inverse=inverse,
        step=step,
        ways=ways,
        inverse_width=1.0,
        large=int(count > _LARGE),
        body=body,
        link=np.zeros((count, 8), dtype=np.int32),
        place=np.zeros((count, 3), dtype=np.int32),
        image=np.zeros((count, 3), dtype=np.int32),
        content=np.zeros((stride, 1 + LISTED), dtype=np.int32),
        spill=np.zeros((stride, max(capacity - LISTED, 1)), dtype=np.int32),
        near=np.zeros(room, dtype=np.int32),
        rows=np.zeros((8, room)),
        times=np.zeros(room),
        bucket=np.zeros(0, dtype=np.int32),
        clock=np.zeros(2),
        tally=np.zeros(4, dtype=np.int64),
        sums=np.zeros(7),
    )
    return _aligned(spheres)


def _aligned(spheres: Spheres) -> Spheres:
    """The same with arrays that begin where cache lines do: no row of 64 bytes is in two."""
    fields: dict[str, Any] = spheres._asdict()
    for name, array in fields.items():
        if isinstance(array, np.ndarray):
            room = np.zeros(array.nbytes + _LINE, dtype=np.uint8)
            start = -room.ctypes.data % _LINE
            fields[name] = room[start : start + array.nbytes].view(array.dtype)
            fields[name] = fields[name].reshape(array.shape)
            fields[name][:] = array
    return Spheres(**fields)


def _colors(reactions: WallReactions | PairReactions | None, s: Spheres, seed: int) -> Colors:
    """The colours, all with q = 1/2 about walls and all A about central particles."""
    count = len(s.body)
    probability = np.array(reactions.probabilities if reactions else (), dtype=float)
    if not ((probability > 0) & (probability <= 1)).all():
        raise EventError(f"probabilities: {probability.tolist()}; each must be in (0, 1]")
    axis, center, cutoff = -1, np.zeros(0, dtype=np.int32), 0.0
    low, extent, references, chance = 0.0, 0.0, 0, 1.0
    if isinstance(reactions, WallReactions):
        axis, references, chance = reactions.axis, 1, 0.5
        if axis not in (0, 1, 2) or not s.wall[axis] or s.size[axis] == 0:
            raise EventError(f"reactions.axis: {axis}; it has no walls")
        low, extent = float(s.low[axis]), float(s.size[axis] * s.cells[axis])
    elif isinstance(reactions, PairReactions):
        center = np.array(reactions.centers, dtype=np.int32)
        references, cutoff = len(center), float(reactions.cutoff)
        if len(set(center.tolist())) != references or not references:
            raise EventError("reactions.centers: at least one, and each only once")
        if center.min() < 0 or center.max() >= count:
            raise EventError(f"reactions.centers: they must be in 0 to {count - 1}")
        if s.wall[s.size > 0].any():
            raise EventError("reactions about central particles need a box without walls")
        largest = float(s.lengths[s.size > 0].min()) / 2
        if not s.diameter < cutoff < largest:
            raise EventError(
                f"reactions.cutoff: {cutoff:g}; it must be above the diameter and below half the "
                f"shortest box length, {largest:g}"
            )
        low, extent = s.diameter, cutoff - s.diameter
    bins = round(extent / s.diameter * _BINS)
    center_of = np.full(count, -1, dtype=np.int32)
    center_of[center] = np.arange(len(center))
    kinds = len(probability)
    return Colors(
        probability=probability,
        axis=axis,
        center=center,
        center_of=center_of,
        cutoff=cutoff,
        label=np.zeros((references, count, kinds), dtype=np.uint8),
        chance=np.full((references, count, kinds), chance),
        visits=np.zeros((references, count), dtype=np.int32),
        settled=np.zeros(1),
        seed=np.uint64(seed),
        reactions=np.zeros((2, 2, kinds)),
        hits=np.zeros(2, dtype=np.int64),
        speeds=np.zeros((2, kinds, SPEED_BINS)),
        low=low,
        width=extent / bins if bins else 1.0,
        number=np.zeros(bins, dtype=np.int64),
        composition=np.zeros((2, bins, kinds)),
        current=np.zeros((2, bins, kinds)),
        samples=np.zeros(1, dtype=np.int64),
        since=np.zeros(1),
    )
