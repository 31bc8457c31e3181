"""When what happens next to a particle: exact times of contact and of leaving the cell."""

from typing import Any

import numpy as np
from numba import njit

from srd_driver.events.state import (
    CELL,
    COUNT,
    EVENT,
    PARTNER,
    PARTNER_COUNT,
    POSITION,
    TIME,
    VELOCITY,
)


def predict(s: Any, i: Any) -> None:
    """Set the next event of particle i: the earliest of its contacts and its end of the cell.

    Two spheres at a distance r with relative velocity u touch after the smaller root of
    |r + u t| = sigma, t = (r^2 - sigma^2) / (sqrt(b^2 - u^2 (r^2 - sigma^2)) - b), b = r.u < 0.
    A contact counts only if it precedes the partner's own event: else the partner, predicted anew
    at that event, will see the contact. So every contact is the event of one of its two particles.
    """
    now = s.clock[0]
    body, link = s.body, s.link
    x, y, z = body[i, 0], body[i, 1], body[i, 2]
    vx, vy, vz = body[i, 3], body[i, 4], body[i, 5]
    own = body[i, TIME]

    best, partner = np.inf, -1
    for axis in range(3):
        velocity = body[i, VELOCITY + axis]
        if velocity != 0.0:
            side = 1 if velocity > 0 else 0
            edge = s.low[axis] + (s.place[i, axis] + side) * s.size[axis]
            time = own + (edge - body[i, POSITION + axis]) / velocity
            if time < best:
                best, partner = time, -1 - 2 * axis - side
    best = max(best, now)

    # gathered first: a loop over a list is predictable, loops over cells of 0 to 3 are not
    near, content = s.near, s.content
    number = 0
    px, py, pz = s.place[i, 0], s.place[i, 1], s.place[i, 2]
    for nz in range(s.ways[2, pz]):
        cell_z = link[i, CELL] + s.step[2, pz, nz]
        for ny in range(s.ways[1, py]):
            cell_y = cell_z + s.step[1, py, ny]
            for nx in range(s.ways[0, px]):
                cell = cell_y + s.step[0, px, nx]
                inside = content[cell, 0]
                near[number] = content[cell, 1]
                near[number + 1] = content[cell, 2]
                near[number + 2] = content[cell, 3]
                if inside > 3:
                    for k in range(3, inside):
                        near[number + k] = content[cell, 1 + k]
                number += inside

    square = s.diameter * s.diameter
    lx, ly, lz = s.lengths[0], s.lengths[1], s.lengths[2]
    ix, iy, iz = s.inverse[0], s.inverse[1], s.inverse[2]
    x += vx * (now - own)
    y += vy * (now - own)
    z += vz * (now - own)
    for n in range(number):
        j = near[n]
        since = now - body[j, TIME]
        ux, uy, uz = body[j, 3] - vx, body[j, 4] - vy, body[j, 5] - vz
        rx = body[j, 0] + body[j, 3] * since - x
        ry = body[j, 1] + body[j, 4] * since - y
        rz = body[j, 2] + body[j, 5] * since - z
        rx -= lx * np.rint(rx * ix)
        ry -= ly * np.rint(ry * iy)
        rz -= lz * np.rint(rz * iz)
        b = rx * ux + ry * uy + rz * uz
        gap = rx * rx + ry * ry + rz * rz - square
        # t > gap / (-2 b): most neighbours are too far for the time that is left
        if b < 0.0 and gap < -2.0 * b * (best - now):
            root = b * b - (ux * ux + uy * uy + uz * uz) * gap
            if root > 0.0:
                time = now + max(gap, 0.0) / (np.sqrt(root) - b)
                if time < best and time < body[j, EVENT]:
                    best, partner = time, j
    body[i, EVENT] = best
    link[i, PARTNER] = partner
    if partner >= 0:
        link[i, PARTNER_COUNT] = link[partner, COUNT]


predict = njit(cache=True, _nrt=False, inline="always")(predict)
