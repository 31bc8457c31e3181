"""Streaming: free flight in a constant field, with bounce-back at the walls.

Arrays hold the components first, (d, N), so that each component is contiguous. Walls stand at
y = 0 and y = width. Equations of tabatabaei-2009, 3.2.1, 3.2.5 and 3.4.3.
"""

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.faults import SimulationFault

MOST_BOUNCES = 100  # in one step; thermal particles need one, two between walls a step apart


def stream(
    positions: Array,
    velocities: Array,
    acceleration: Array,
    time: float,
    width: float | None = None,
) -> None:
    """Move particles in place for a time under a constant acceleration (3.3, 3.51).

    r(t) = r + v t + a t^2 / 2 and v(t) = v + a t. A particle that would end beyond a wall is taken
    through `bounce_back` instead.

    Args:
        positions: (d, N) [a0].
        velocities: (d, N) [a0/t0].
        acceleration: (d, N), or (d, 1) for all alike [a0/t0^2].
        time: [t0].
        width: distance between the walls [a0]; None: no walls.
    """
    end = positions + time * (velocities + 0.5 * time * acceleration)
    end_velocities = velocities + time * acceleration
    if width is not None:
        crossing = np.flatnonzero((end[1] < 0) | (end[1] > width))
        if crossing.size:
            end[:, crossing], end_velocities[:, crossing] = bounce_back(
                positions[:, crossing],
                velocities[:, crossing],
                np.broadcast_to(acceleration, positions.shape)[:, crossing],
                time,
                width,
                crossing,
            )
    positions[:] = end
    velocities[:] = end_velocities


def bounce_back(
    positions: Array,
    velocities: Array,
    acceleration: Array,
    time: float,
    width: float,
    names: NDArray[np.intp],
) -> tuple[Array, Array]:
    """Positions and velocities after `time`, reversed at each contact with a wall.

    At the contact, t_c later, the particle has v_c = v + a t_c (3.13 corrected); it leaves with
    -v_c and flies on with the same acceleration for the rest (3.11), again bounced if it comes
    back. Whoever ends between the walls has not met one: a particle that a force away from the
    wall turns back outside, within the step, is not seen.

    Args:
        positions, velocities, acceleration: (d, n), between the walls at the start.
        time, width: as for `stream`.
        names: particle numbers (n,), for the fault.
    """
    r, v, a = positions, velocities, acceleration
    left = np.full(r.shape[1], time)
    flying = np.arange(r.shape[1])
    end_positions, end_velocities = np.empty_like(r), np.empty_like(v)
    for _ in range(MOST_BOUNCES):
        end = r + left * (v + 0.5 * left * a)
        beyond = (end[1] < 0) | (end[1] > width)
        landed = ~beyond
        end_positions[:, flying[landed]] = end[:, landed]
        end_velocities[:, flying[landed]] = (v + left * a)[:, landed]
        if not beyond.any():
            return end_positions, end_velocities
        flying, left = flying[beyond], left[beyond]
        r, v, a = r[:, beyond], v[:, beyond], a[:, beyond]
        outwards = np.where(end[1, beyond] < 0, -1.0, 1.0)
        wall = np.where(outwards < 0, 0.0, width)
        contact = contact_time(outwards * (wall - r[1]), outwards * v[1], outwards * a[1])
        contact = np.minimum(contact, left)
        r = r + contact * (v + 0.5 * contact * a)
        r[1] = wall
        v = -(v + contact * a)
        left = left - contact
    raise SimulationFault(
        f"fluid particle {names[flying[0]]} meets the walls more than {MOST_BOUNCES} times in "
        "one step: it is too fast, or pressed against a wall"
    )


def contact_time(distance: Array, velocity: Array, acceleration: Array) -> Array:
    """First t with v t + a t^2 / 2 = distance (3.44 corrected), for a wall that is reached.

    Without acceleration this is (3.9). Of the two forms of the root, each particle takes the one
    that subtracts nothing.

    Args:
        distance: to the wall, >= 0 (n,) [a0].
        velocity, acceleration: components towards the wall (n,).
    """
    speed = np.sqrt(np.maximum(velocity**2 + 2 * acceleration * distance, 0.0))  # at the wall
    with np.errstate(divide="ignore", invalid="ignore"):
        approaching = 2 * distance / (velocity + speed)
        returning = (speed - velocity) / acceleration
    return np.where(velocity > 0, approaching, returning)
