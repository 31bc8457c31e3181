"""Fetching what coming events will need, for systems too large for the caches: it changes nothing.

The queue knows the next events long before they come, so the memory of their particles, of the
cells around them and of their neighbours can be asked for while others are worked on.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from srd_driver.events.compiling import inlined
from srd_driver.events.state import NEXT, PARTNER

STRIDE = 4  # buckets from one to the next that is looked at


@intrinsic  # type: ignore[untyped-decorator]
def fetch(context: Any, array: Any, i: Any) -> Any:
    """Ask for the cache line of row i of a two-dimensional array."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = signature.args[0]
        rows = context.make_array(kind)(context, builder, arguments[0])
        zero = context.get_constant(types.intp, 0)
        at = context.cast(builder, arguments[1], signature.args[1], types.intp)
        place = cgutils.get_item_pointer(context, builder, kind, rows, [at, zero], wraparound=False)
        byte = ir.IntType(8).as_pointer()
        number = ir.IntType(32)
        ask = cgutils.get_or_insert_function(
            builder.module,
            ir.FunctionType(ir.VoidType(), [byte, number, number, number]),
            "llvm.prefetch.p0i8",
        )
        builder.call(ask, [builder.bitcast(place, byte), number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, i), code


def fetch_particle(s: Any, i: Any) -> None:
    """What an event reads of a particle."""
    fetch(s.body, i)
    fetch(s.link, i)
    fetch(s.place, i)


def fetch_cells(s: Any, x: Any, y: Any, z: Any) -> None:
    """The lists of the particles in the cells about a place; those along x share lines."""
    for nz in range(s.ways[2, z]):
        for ny in range(s.ways[1, y]):
            row = x + s.cells[0] * (y + s.cells[1] * z) + s.step[2, z, nz] + s.step[1, y, ny]
            fetch(s.content, row + s.step[0, x, 0])
            fetch(s.content, row + s.step[0, x, s.ways[0, x] - 1])


def fetch_neighbors(s: Any, x: Any, y: Any, z: Any) -> None:
    """The particles in the cells about a place, those beyond the third of a cell left out."""
    for nz in range(s.ways[2, z]):
        for ny in range(s.ways[1, y]):
            row = x + s.cells[0] * (y + s.cells[1] * z) + s.step[2, z, nz] + s.step[1, y, ny]
            for nx in range(s.ways[0, x]):
                cell = row + s.step[0, x, nx]
                for k in range(1, 1 + min(s.content[cell, 0], 3)):
                    fetch(s.body, s.content[cell, k])


def other_place(s: Any, i: Any) -> Any:
    """Where else the event of particle i is: at its partner, or in the cell that it comes to."""
    partner = s.link[i, PARTNER]
    if partner >= 0:
        return s.place[partner, 0], s.place[partner, 1], s.place[partner, 2]
    axis, side = (-1 - partner) >> 1, (-1 - partner) & 1
    x, y, z = s.place[i, 0], s.place[i, 1], s.place[i, 2]
    target = s.place[i, axis] + 2 * side - 1
    target = min(max(target, 0), s.cells[axis] - 1)  # at faces of the box it may be another
    return (
        target if axis == 0 else x,
        target if axis == 1 else y,
        target if axis == 2 else z,
    )


fetch_particle = inlined(fetch_particle)
fetch_cells = inlined(fetch_cells)
fetch_neighbors = inlined(fetch_neighbors)
other_place = inlined(other_place)


def look_ahead(s: Any) -> None:
    """For events of buckets to come, the later the bucket the less is known of what they need."""
    now, last = int(s.clock[1]), s.bucket.size - 1
    i = s.bucket[(now + 4 * STRIDE) & last]
    if i >= 0:
        fetch_particle(s, i)
    i = s.bucket[(now + 3 * STRIDE) & last]
    while i >= 0:
        if s.link[i, PARTNER] >= 0:
            fetch_particle(s, s.link[i, PARTNER])
        fetch_cells(s, s.place[i, 0], s.place[i, 1], s.place[i, 2])
        i = s.link[i, NEXT]
    i = s.bucket[(now + 2 * STRIDE) & last]
    while i >= 0:
        x, y, z = other_place(s, i)
        fetch_cells(s, x, y, z)
        fetch_neighbors(s, s.place[i, 0], s.place[i, 1], s.place[i, 2])
        i = s.link[i, NEXT]
    i = s.bucket[(now + STRIDE) & last]
    while i >= 0:
        x, y, z = other_place(s, i)
        fetch_neighbors(s, x, y, z)
        i = s.link[i, NEXT]


look_ahead = inlined(look_ahead)
