"""The event loop: collisions, walls and cell crossings in the order of their times.

D. C. Rapaport, The Art of Molecular Dynamics Simulation (Cambridge, 2004), chapter 14, with one
event for each particle and lazy invalidation: an event whose partner has collided meanwhile is not
removed but, when its time comes, the particle's next event is predicted anew.
"""

from typing import Any

import numpy as np

from srd_driver.events.colors import pass_surfaces, react, settle
from srd_driver.events.compiling import compiled, inlined
from srd_driver.events.prediction import predict
from srd_driver.events.queue import first, insert, remove
from srd_driver.events.state import (
    CELL,
    COLLISIONS,
    COUNT,
    CROSSINGS,
    EVENT,
    LISTED,
    PARTNER,
    PARTNER_COUNT,
    POSITION,
    REPREDICTED,
    TIME,
    VELOCITY,
    VIRIAL,
    WALL_HITS,
    WALL_MOMENTUM,
)


def member(s: Any, cell: Any, k: Any) -> Any:
    return s.content[cell, 1 + k] if k < LISTED else s.spill[cell, k - LISTED]


def put(s: Any, cell: Any, k: Any, i: Any) -> None:
    if k < LISTED:
        s.content[cell, 1 + k] = i
    else:
        s.spill[cell, k - LISTED] = i


member = inlined(member)
put = inlined(put)


def enter_cell(s: Any, i: Any, cell: Any) -> None:
    s.link[i, CELL] = cell
    inside = s.content[cell, 0]
    s.content[cell, 0] = inside + 1
    put(s, cell, inside, i)


def leave_cell(s: Any, i: Any) -> None:
    cell = s.link[i, CELL]
    last = s.content[cell, 0] - 1
    k = 0
    while member(s, cell, k) != i:
        k += 1
    put(s, cell, k, member(s, cell, last))
    s.content[cell, 0] = last


def move(s: Any, i: Any, now: Any) -> None:
    """Free flight of particle i to the time `now`."""
    since = now - s.body[i, TIME]
    for axis in range(3):
        s.body[i, POSITION + axis] += s.body[i, VELOCITY + axis] * since
    s.body[i, TIME] = now


enter_cell = inlined(enter_cell)
leave_cell = inlined(leave_cell)
move = inlined(move)


def collide(s: Any, c: Any, i: Any, j: Any, now: Any) -> None:
    """Elastic collision of equal spheres: the velocities along the centres change places."""
    body = s.body
    if c.center.size:
        pass_surfaces(s, c, i, now)
    move(s, i, now)
    if c.center.size:
        pass_surfaces(s, c, j, now)
    move(s, j, now)
    r = (0.0, 0.0, 0.0)
    b = square = 0.0
    for axis in range(3):
        distance = body[j, POSITION + axis] - body[i, POSITION + axis]
        distance -= s.lengths[axis] * np.rint(distance * s.inverse[axis])
        r = (r[1], r[2], distance)
        square += distance * distance
        b += distance * (body[j, VELOCITY + axis] - body[i, VELOCITY + axis])
    if c.center.size:
        speed = -b / np.sqrt(square)
        if c.center_of[i] >= 0:
            react(c, c.center_of[i], j, 0, speed)
        if c.center_of[j] >= 0:
            react(c, c.center_of[j], i, 0, speed)
    for axis in range(3):
        change = r[axis] * (b / square)
        body[i, VELOCITY + axis] += change
        body[j, VELOCITY + axis] -= change
    s.sums[VIRIAL] -= b
    s.tally[COLLISIONS] += 1
    s.link[i, COUNT] += 1
    s.link[j, COUNT] += 1


collide = inlined(collide)


def leave(s: Any, c: Any, i: Any, axis: Any, side: Any, now: Any) -> None:
    """Particle i at the end of its cell: a wall, a periodic face, or the next cell."""
    body = s.body
    if c.center.size:
        pass_surfaces(s, c, i, now)
    move(s, i, now)
    place = s.place[i, axis]
    body[i, POSITION + axis] = s.low[axis] + (place + side) * s.size[axis]
    target = place + 2 * side - 1
    if target < 0 or target >= s.cells[axis]:
        if s.wall[axis]:
            speed = abs(body[i, VELOCITY + axis])
            if axis == c.axis:
                react(c, 0, i, side, speed)
            body[i, VELOCITY + axis] = -body[i, VELOCITY + axis]
            s.sums[WALL_MOMENTUM + 2 * axis + side] += 2 * speed
            s.tally[WALL_HITS] += 1
            s.link[i, COUNT] += 1
            return
        s.image[i, axis] += 2 * side - 1
        target = 0 if side else s.cells[axis] - 1
        body[i, POSITION + axis] = 0.0 if side else s.lengths[axis]
    leave_cell(s, i)
    s.place[i, axis] = target
    enter_cell(s, i, s.place[i, 0] + s.cells[0] * (s.place[i, 1] + s.cells[1] * s.place[i, 2]))
    s.tally[CROSSINGS] += 1


leave = inlined(leave)


def advance(s: Any, c: Any, until: Any) -> None:
    """All events up to the time `until`; the particles' own times stay behind."""
    body, link = s.body, s.link
    while True:
        i = first(s, until)
        if i < 0:
            break
        now = body[i, EVENT]
        s.clock[0] = now
        remove(s, i)
        partner, other = link[i, PARTNER], -1
        if partner < 0:
            code = -1 - partner
            leave(s, c, i, code >> 1, code & 1, now)
        elif link[partner, COUNT] == link[i, PARTNER_COUNT]:
            collide(s, c, i, partner, now)
            remove(s, partner)
            body[i, EVENT] = np.inf
            body[partner, EVENT] = np.inf
            other = partner
        else:
            s.tally[REPREDICTED] += 1
        while i >= 0:
            predict(s, i)
            insert(s, i)
            i, other = other, -1
    s.clock[0] = until
    if c.center.size:
        settle(s, c)


advance = compiled(advance, nogil=True)


def fill_cells(s: Any) -> None:
    """Put every particle in its cell."""
    for i in range(s.body.shape[0]):
        for axis in range(3):
            if s.size[axis] > 0:
                place = int((s.body[i, POSITION + axis] - s.low[axis]) / s.size[axis])
                s.place[i, axis] = min(max(place, 0), s.cells[axis] - 1)
        enter_cell(s, i, s.place[i, 0] + s.cells[0] * (s.place[i, 1] + s.cells[1] * s.place[i, 2]))


def predict_all(s: Any) -> Any:
    """Predict the event of every particle; how far ahead they lie in the mean."""
    count = s.body.shape[0]
    s.body[:, EVENT] = np.inf
    ahead = 0.0
    for i in range(count):
        predict(s, i)
        ahead += s.body[i, EVENT] / count
    return ahead


def file_all(s: Any) -> None:
    """Put every particle in its bucket."""
    for i in range(s.body.shape[0]):
        insert(s, i)


def nearest(s: Any) -> Any:
    """The nearest two spheres and their distance, among those in neighbouring cells."""
    now, body = s.clock[0], s.body
    least, first_of, second = np.inf, -1, -1
    for i in range(body.shape[0]):
        px, py, pz = s.place[i, 0], s.place[i, 1], s.place[i, 2]
        for nz in range(s.ways[2, pz]):
            for ny in range(s.ways[1, py]):
                for nx in range(s.ways[0, px]):
                    cell = s.link[i, CELL] + s.step[0, px, nx]
                    cell += s.step[1, py, ny] + s.step[2, pz, nz]
                    for k in range(s.content[cell, 0]):
                        j = member(s, cell, k)
                        if j > i:
                            square = 0.0
                            for axis in range(3):
                                r = body[j, POSITION + axis] - body[i, POSITION + axis]
                                r += body[j, VELOCITY + axis] * (now - body[j, TIME])
                                r -= body[i, VELOCITY + axis] * (now - body[i, TIME])
                                r -= s.lengths[axis] * np.rint(r * s.inverse[axis])
                                square += r * r
                            if square < least:
                                least, first_of, second = square, i, j
    return first_of, second, np.sqrt(least)


fill_cells = compiled(fill_cells)
predict_all = compiled(predict_all)
file_all = compiled(file_all)
nearest = compiled(nearest)
