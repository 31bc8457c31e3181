"""Density, composition and colour current in bins, along an axis or about central particles."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.events.compiling import compiled
from srd_driver.events.state import POSITION, TIME, VELOCITY


@dataclass(frozen=True)
class Profile:
    """What a stretch of time has shown of the colours, summed.

    With B bins and K reaction probabilities; a leading 2 is by labels, and by q.

    Attributes:
        time: length of the stretch.
        samples: how often the bins were looked at.
        references: 1 (the walls), or the number of central particles.
        positions: middles of the bins, (B,): along the axis in the box, or distances.
        width: of a bin.
        number: particles in each bin, summed over samples and references, (B,).
        composition: of them A, (2, B, K).
        current: sum of the velocities of A, along the axis or away from the centre, (2, B, K).
        reactions: A to B and B to A, (2 surfaces, 2, K).
        hits: visits to the surfaces, (2,).
        speeds: normal speeds of particles that reacted, in bins of `SPEED_BIN`, (2, K, 120).
    """

    time: float
    samples: int
    references: int
    positions: Array
    width: float
    number: NDArray[np.int64]
    composition: Array
    current: Array
    reactions: Array
    hits: NDArray[np.int64]
    speeds: Array


def add(c: Any, bin_: Any, m: Any, i: Any, velocity: Any) -> None:
    """One particle into one bin."""
    c.number[bin_] += 1
    for k in range(c.probability.size):
        label, q = c.label[m, i, k], c.chance[m, i, k]
        c.composition[0, bin_, k] += label
        c.composition[1, bin_, k] += q
        c.current[0, bin_, k] += label * velocity
        c.current[1, bin_, k] += q * velocity


add = compiled(add)


def sample(s: Any, c: Any) -> None:
    """Add the present state to the sums of the bins."""
    now, body, bins = s.clock[0], s.body, c.number.size
    if c.axis >= 0:
        for i in range(body.shape[0]):
            velocity = body[i, VELOCITY + c.axis]
            place = body[i, POSITION + c.axis] + velocity * (now - body[i, TIME]) - c.low
            add(c, min(max(int(place / c.width), 0), bins - 1), 0, i, velocity)
    for m in range(c.center.size):
        center = c.center[m]
        for i in range(body.shape[0]):
            if i == center:
                continue
            square = product = 0.0
            for axis in range(3):
                u = body[i, VELOCITY + axis] - body[center, VELOCITY + axis]
                r = (
                    body[i, POSITION + axis]
                    + body[i, VELOCITY + axis] * (now - body[i, TIME])
                    - body[center, POSITION + axis]
                    - body[center, VELOCITY + axis] * (now - body[center, TIME])
                )
                r -= s.lengths[axis] * np.rint(r * s.inverse[axis])
                square += r * r
                product += r * u
            distance = np.sqrt(square)
            bin_ = int(max(distance - c.low, 0.0) / c.width)
            if bin_ < bins:
                add(c, bin_, m, i, product / distance)
    c.samples[0] += 1


sample = compiled(sample)
