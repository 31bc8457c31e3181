"""Walls across any axes, at rest or moving along themselves: streaming and virtual particles.

Walls stand at 0 and at the length of the box along each axis that is not periodic. Equations of
tabatabaei-2009, 3.2.1 and 3.2.5; moving walls as in hecht-2005, VIII C. Arrays hold the components
first, (d, N).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream
from srd_driver.reference.faults import SimulationFault
from srd_driver.reference.streaming import contact_time

MOST_BOUNCES = 10_000  # in one step; where two walls meet to and fro along a chord of the corner


@dataclass(frozen=True)
class Boundaries:
    """A box with walls across some axes.

    Attributes:
        box: lengths (d,) [a0].
        periodic: for each axis; the others have walls.
        velocities: of moving walls, by (axis, upper) (d,) [a0/t0]; the others are at rest.
        density: particles that a cut cell is filled up to; 0: cells are left as they are.
        taken: momentum that walls took up since it was last cleared, by (axis, upper) (d,).
    """

    box: tuple[float, ...]
    periodic: tuple[bool, ...]
    velocities: dict[tuple[int, bool], tuple[float, ...]] = field(default_factory=dict)
    density: float = 0.0
    taken: dict[tuple[int, bool], Array] = field(default_factory=dict, repr=False, compare=False)

    def take(self, axis: int, upper: bool, momentum: Array) -> None:
        """Add to what a wall took up (d,)."""
        self.taken[axis, upper] = self.taken.get((axis, upper), 0.0) + momentum

    @property
    def walled(self) -> list[int]:
        """The axes that walls stand across."""
        return [axis for axis, periodic in enumerate(self.periodic) if not periodic]

    def velocity(self, axis: int, upper: bool) -> Array:
        """Of a wall (d,) [a0/t0]."""
        return np.array(self.velocities.get((axis, upper), (0.0,) * len(self.box)))

    def beyond(self, positions: Array) -> NDArray[np.bool_]:
        """Whether each particle is beyond each face (d, 2, N)."""
        beyond = np.zeros((len(self.box), 2, positions.shape[1]), dtype=bool)
        for axis in self.walled:
            beyond[axis, 0] = positions[axis] < 0
            beyond[axis, 1] = positions[axis] > self.box[axis]
        return beyond

    def wrap(self, positions: Array) -> None:
        """Into the box, in place, along the periodic axes."""
        for axis, size in enumerate(self.box):
            if self.periodic[axis]:
                positions[axis] -= size * np.floor(positions[axis] / size)
                positions[axis][positions[axis] >= size] = 0.0


def stream(
    positions: Array,
    velocities: Array,
    acceleration: Array,
    time: float | Array,
    boundaries: Boundaries,
) -> None:
    """Move particles in place for a time, bounced back at each contact with a wall (3.11, 3.13).

    In the frame of the wall the velocity is reversed: v becomes 2 V - v. Of several walls that a
    particle would end beyond, it meets the one that it reaches first.

    Args:
        positions: (d, N) [a0].
        velocities: (d, N) [a0/t0].
        acceleration: (d, 1) [a0/t0^2].
        time: [t0], one for all or each its own (N,).
        boundaries: the walls.

    Raises:
        SimulationFault: for a particle that meets walls more than MOST_BOUNCES times.
    """
    left = np.broadcast_to(np.asarray(time, dtype=float), positions.shape[1:]).copy()
    flying = np.arange(positions.shape[1])
    for _ in range(MOST_BOUNCES):
        r, v, rest = positions[:, flying], velocities[:, flying], left[flying]
        end = r + rest * (v + 0.5 * rest * acceleration)
        beyond = boundaries.beyond(end)
        landed = ~beyond.any(axis=(0, 1))
        positions[:, flying[landed]] = end[:, landed]
        velocities[:, flying[landed]] += rest[landed] * acceleration
        flying, beyond = flying[~landed], beyond[:, :, ~landed]
        if not flying.size:
            return
        r, v, rest = r[:, ~landed], v[:, ~landed], rest[~landed]
        first, face = np.full(flying.size, np.inf), np.zeros(flying.size, dtype=int)
        for axis in boundaries.walled:
            for upper in (0, 1):
                outwards, wall = (1.0, boundaries.box[axis]) if upper else (-1.0, 0.0)
                contact = np.minimum(
                    contact_time(
                        outwards * (wall - r[axis]),
                        outwards * v[axis],
                        np.broadcast_to(outwards * acceleration[axis], rest.shape),
                    ),
                    rest,
                )
                earlier = beyond[axis, upper] & (contact < first)
                first[earlier], face[earlier] = contact[earlier], 2 * axis + upper
        r = r + first * (v + 0.5 * first * acceleration)
        v = v + first * acceleration
        for axis in boundaries.walled:
            for upper in (0, 1):
                met = face == 2 * axis + upper
                r[axis, met] = boundaries.box[axis] if upper else 0.0
                arrived = v[:, met]
                v[:, met] = 2 * boundaries.velocity(axis, bool(upper))[:, None] - arrived
                boundaries.take(axis, bool(upper), (arrived - v[:, met]).sum(axis=1))
        positions[:, flying], velocities[:, flying] = r, v
        left[flying] = rest - first
    raise SimulationFault(
        f"fluid particle {flying[0]} meets the walls more than {MOST_BOUNCES} times in one step: "
        "it is too fast, or pressed against a wall"
    )


def cut_cells(boundaries: Boundaries, cells: Cells, shift: Array) -> NDArray[np.bool_]:
    """Whether each cell of a shifted grid reaches beyond each face (d, 2, cells)."""
    number = np.arange(cells.count)
    cut = np.zeros((len(cells.shape), 2, cells.count), dtype=bool)
    for axis, rows in enumerate(cells.shape):
        start = number % rows - shift[axis]
        number = number // rows
        if not boundaries.periodic[axis]:
            cut[axis] = start < 0, start + 1 > boundaries.box[axis]
    return cut


def take_from_cells(boundaries: Boundaries, cut: NDArray[np.bool_], lost: Array) -> None:
    """What cells lost (d, cells) goes to the walls that cut them, in equal parts."""
    share = lost / np.maximum(cut.sum(axis=(0, 1)), 1)
    for axis in boundaries.walled:
        for upper in (False, True):
            boundaries.take(axis, upper, share[:, cut[axis, int(upper)]].sum(axis=1))


def virtual_particles(
    boundaries: Boundaries,
    cut: NDArray[np.bool_],
    fluid: Array,
    temperature: float,
    random: CounterRandom,
) -> tuple[Array, Array]:
    """Number (cells,) and total momentum (d, cells) of the virtual particles of each cell (3.14).

    A cell that walls cut, with n < n_f fluid particles in it, gets n_f - n more, with the velocity
    of its wall, or the mean of its walls, on average, and a normal of variance (n_f - n) kBT in
    each component of their momentum.

    Args:
        boundaries: the walls.
        cut: the cells that they cut, as `cut_cells` has it.
        fluid: number of fluid particles in each cell (cells,).
        temperature: kBT.
        random: of this collision.
    """
    dimensions, count = len(boundaries.box), len(fluid)
    of_walls, walls = np.zeros((dimensions, count)), cut.sum(axis=(0, 1))
    for axis in boundaries.walled:
        for upper in (False, True):
            velocity = boundaries.velocity(axis, upper)[:, None]
            of_walls[:, cut[axis, int(upper)]] += velocity
    missing = np.where(walls > 0, np.maximum(boundaries.density - fluid, 0.0), 0.0)
    mean = of_walls / np.maximum(walls, 1)
    noise = random.normal(Stream.WALL, count)[:dimensions]
    return missing, missing * mean + np.sqrt(missing * temperature) * noise
