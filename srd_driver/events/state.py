"""The arrays of an event-driven simulation: all of its state, and all that a restart keeps.

Everything the compiled kernel works on is a field of one of two named tuples, so that saving the
fields is saving the simulation, bit for bit.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array

Integers = NDArray[np.int32]

# columns of `Spheres.body`, one particle in one cache line
POSITION, VELOCITY, TIME, EVENT = 0, 3, 6, 7
# columns of `Spheres.link`; one is left to fill half a cache line
PARTNER, PARTNER_COUNT, COUNT, NEXT, PREVIOUS, BUCKET, CELL = range(7)
LISTED = 3  # particles in a row of `Spheres.content`
ROW = 8  # numbers in a cache line, and in a register
# entries of `Spheres.tally`
COLLISIONS, WALL_HITS, CROSSINGS, REPREDICTED = range(4)
# entries of `Spheres.sums`: sum of sigma |b|, and momentum given to the six walls
VIRIAL, WALL_MOMENTUM = 0, 1


class Spheres(NamedTuple):
    """Hard spheres, their cells and their queue of events.

    Lengths and times in the caller's units, mass 1. Two-dimensional systems have z = 0.

    Attributes:
        diameter: of all spheres.
        lengths: of the box, (3,); 0 along z in two dimensions.
        low: where the centres' range begins, (3,): 0, or half a diameter from a wall.
        size: edge lengths of a cell, (3,); walls and periodic faces lie on cell faces.
        cells: along each axis, (3,).
        wall: 1 on axes that end at walls (or, along z in two dimensions, nowhere), (3,).
        inverse: 1 / lengths on periodic axes, else 0, (3,), for the nearest image.
        step, ways: neighbours of a cell along an axis, as steps in the cell number (3, longest, 3),
            and how many there are (3, longest).
        inverse_width: of a bucket of the queue.
        large: 1 where `look_ahead` pays, else 0.
        body: (N, 8), position and velocity at the particle's own time, that time, and the time of
            its next event.
        link: (N, 8): partner of the next event (or -1 - 2 axis - side: end of the cell) and the
            partner's count of collisions when the event was predicted; own count; next and previous
            in the bucket; bucket; cell.
        place: cell coordinates, (N, 3).
        image: box lengths to add to the positions, (N, 3).
        content: number of particles in each cell, and the first three, (cells, 1 + `LISTED`).
        spill: the others, which few cells have, (cells, capacity - `LISTED`).
        near: room for the particles of 27 cells, and to fill a `ROW`.
        rows: room for what `body` has of them, (8, as many).
        times: room for the times of their contacts.
        bucket: first particle of each bucket.
        clock: (2,), the time, and the number of the bucket that is being emptied.
        tally: numbers of collisions, wall hits, cell crossings and renewed predictions, (4,).
        sums: (7,), see `VIRIAL`, `WALL_MOMENTUM`.
    """

    diameter: float
    lengths: Array
    low: Array
    size: Array
    cells: Integers
    wall: Integers
    inverse: Array
    step: Integers
    ways: Integers
    inverse_width: float
    large: int
    body: Array
    link: Integers
    place: Integers
    image: Integers
    content: Integers
    spill: Integers
    near: Integers
    rows: Array
    times: Array
    bucket: Integers
    clock: Array
    tally: NDArray[np.int64]
    sums: Array


class Colors(NamedTuple):
    """Labels that no particle feels: A or B, one set for each reference and probability.

    With M references (the two walls: M = 1; or M central particles) and K reaction probabilities:

    Attributes:
        probability: (K,).
        axis: whose walls react, or -1.
        center: numbers of the central particles, (M,); empty when walls react.
        center_of: (N,), which reference a particle is, or -1.
        cutoff: distance of the imaginary reaction surface from a central particle.
        label: (M, N, K), 1 for A, drawn by lot at each reaction.
        chance: (M, N, K), the probability q to be A given the trajectory: the mean of `label`
            over all lots.
        visits: to reaction surfaces by each particle, (M, N): with the seed, they make its lots.
        settled: time up to which entries into the imaginary spheres are accounted for, (1,).
        seed: of the lots.
        reactions: (2, 2, K): A to B and B to A; counted with labels, expected with q.
        hits: (2,), visits to the two reaction surfaces.
        speeds: (2, K, 120): normal speeds of particles that reacted, in bins of 1/20, by labels
            and by q.
        low, width: where the bins of the profiles begin, and their width.
        number: particles by bin, summed over samples and references, (B,).
        composition: the sum of label and of q in each bin, (2, B, K).
        current: the same times the velocity along the axis, or away from the centre, (2, B, K).
        samples: (1,).
        since: time at which the sums begin, (1,).
    """

    probability: Array
    axis: int
    center: Integers
    center_of: Integers
    cutoff: float
    label: NDArray[np.uint8]
    chance: Array
    visits: Integers
    settled: Array
    seed: np.uint64
    reactions: Array
    hits: NDArray[np.int64]
    speeds: Array
    low: float
    width: float
    number: NDArray[np.int64]
    composition: Array
    current: Array
    samples: NDArray[np.int64]
    since: Array


SPEED_BINS = 120
SPEED_BIN = 0.05
