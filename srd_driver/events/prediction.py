"""When what happens next to a particle: exact times of contact and of leaving the cell."""

from typing import Any

import numpy as np

from srd_driver.events.compiling import inlined
from srd_driver.events.state import (
    CELL,
    COUNT,
    EVENT,
    LISTED,
    PARTNER,
    PARTNER_COUNT,
    POSITION,
    ROW,
    TIME,
    VELOCITY,
)


def end_of_cell(s: Any, i: Any) -> Any:
    """When particle i leaves its cell, and how: -1 - 2 axis - side."""
    body = s.body
    best, code = np.inf, -1
    for axis in range(3):
        velocity = body[i, VELOCITY + axis]
        if velocity != 0.0:
            side = 1 if velocity > 0 else 0
            edge = s.low[axis] + (s.place[i, axis] + side) * s.size[axis]
            time = body[i, TIME] + (edge - body[i, POSITION + axis]) / velocity
            if time < best:
                best, code = time, -1 - 2 * axis - side
    return max(best, s.clock[0]), code


def list_neighbors(s: Any, i: Any) -> Any:
    """Write the particles of the cells about particle i into `near`; how many there are.

    Each cell gives its first entries, whether it has so many or not: the next cell overwrites the
    surplus. So the loop has no branch that depends on the data. The list ends with particle i
    itself, which meets nobody, up to a multiple of `ROW`.
    """
    near, content, spill = s.near, s.content, s.spill
    number = 0
    px, py, pz = s.place[i, 0], s.place[i, 1], s.place[i, 2]
    for nz in range(s.ways[2, pz]):
        cell_z = s.link[i, CELL] + s.step[2, pz, nz]
        for ny in range(s.ways[1, py]):
            cell_y = cell_z + s.step[1, py, ny]
            for nx in range(s.ways[0, px]):
                cell = cell_y + s.step[0, px, nx]
                inside = content[cell, 0]
                near[number] = content[cell, 1]
                near[number + 1] = content[cell, 2]
                near[number + 2] = content[cell, 3]
                for k in range(LISTED, inside):
                    near[number + k] = spill[cell, k - LISTED]
                number += inside
    whole = (number + ROW - 1) // ROW * ROW
    for n in range(number, whole):
        near[n] = i
    return whole


def contact_times(s: Any, i: Any, number: Any) -> None:
    """Write when particle i meets each of the listed ones into `times`; infinity: never.

    Without branches and from columns that are copied first, for the compiler to do eight at once.
    """
    now, body = s.clock[0], s.body
    near, rows, times = s.near, s.rows, s.times
    own = now - body[i, TIME]
    vx, vy, vz = body[i, 3], body[i, 4], body[i, 5]
    x, y, z = body[i, 0] + vx * own, body[i, 1] + vy * own, body[i, 2] + vz * own
    square = s.diameter * s.diameter
    lx, ly, lz = s.lengths[0], s.lengths[1], s.lengths[2]
    ix, iy, iz = s.inverse[0], s.inverse[1], s.inverse[2]
    for n in range(number):
        j = np.uint32(near[n])
        for k in range(8):
            rows[k, n] = body[j, k]
    for n in range(number):
        since = now - rows[6, n]
        ux, uy, uz = rows[3, n] - vx, rows[4, n] - vy, rows[5, n] - vz
        rx = rows[0, n] + rows[3, n] * since - x
        ry = rows[1, n] + rows[4, n] * since - y
        rz = rows[2, n] + rows[5, n] * since - z
        rx -= lx * np.rint(rx * ix)
        ry -= ly * np.rint(ry * iy)
        rz -= lz * np.rint(rz * iz)
        b = rx * ux + ry * uy + rz * uz
        gap = rx * rx + ry * ry + rz * rz - square
        root = b * b - (ux * ux + uy * uy + uz * uz) * gap
        meets = (b < 0.0) & (root > 0.0)
        time = now + max(gap, 0.0) / (np.sqrt(root) - b)
        times[n] = time if meets else np.inf


end_of_cell = inlined(end_of_cell)
list_neighbors = inlined(list_neighbors)
contact_times = inlined(contact_times)


def predict(s: Any, i: Any) -> None:
    """Set the next event of particle i: the earliest of its contacts and its end of the cell.

    Two spheres at a distance r with relative velocity u touch after the smaller root of
    |r + u t| = sigma, t = (r^2 - sigma^2) / (sqrt(b^2 - u^2 (r^2 - sigma^2)) - b), b = r.u < 0.
    A contact counts only if it precedes the partner's own event: else the partner, predicted anew
    at that event, will see the contact. So every contact is the event of one of its two particles.
    """
    best, partner = end_of_cell(s, i)
    number = list_neighbors(s, i)
    contact_times(s, i, number)
    for n in range(number):
        if s.times[n] < best and s.times[n] < s.rows[EVENT, n]:
            best, partner = s.times[n], s.near[n]
    s.body[i, EVENT] = best
    s.link[i, PARTNER] = partner
    if partner >= 0:
        s.link[i, PARTNER_COUNT] = s.link[partner, COUNT]


predict = inlined(predict)
