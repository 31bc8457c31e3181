"""The queue of events: buckets of time in a ring, at a cost that does not grow with their number.

After G. Paul, J. Comput. Phys. 221, 615 (2007): one event for each particle, in the bucket of its
time; buckets are so narrow that about one event is in each, and the earliest of the current bucket
is looked for. Events beyond the ring wait in its last bucket and are filed again from there.
"""

from typing import Any

from srd_driver.events.compiling import inlined
from srd_driver.events.look_ahead import look_ahead
from srd_driver.events.state import BUCKET, EVENT, NEXT, PREVIOUS


def insert(s: Any, i: Any) -> None:
    """File particle i by the time of its event."""
    first = s.clock[1]
    k = min(max(s.body[i, EVENT] * s.inverse_width, first), first + s.bucket.size - 1)
    slot = int(k) & (s.bucket.size - 1)
    follower = s.bucket[slot]
    s.link[i, NEXT] = follower
    s.link[i, PREVIOUS] = -1
    s.link[i, BUCKET] = slot
    if follower >= 0:
        s.link[follower, PREVIOUS] = i
    s.bucket[slot] = i


def remove(s: Any, i: Any) -> None:
    """Take particle i out of its bucket."""
    follower, leader = s.link[i, NEXT], s.link[i, PREVIOUS]
    if leader >= 0:
        s.link[leader, NEXT] = follower
    else:
        s.bucket[s.link[i, BUCKET]] = follower
    if follower >= 0:
        s.link[follower, PREVIOUS] = leader


insert = inlined(insert)
remove = inlined(remove)


def first(s: Any, until: Any) -> Any:
    """The particle with the earliest event, or -1 if that is after `until`."""
    last = float(int(until * s.inverse_width))
    while True:
        current = s.clock[1]
        earliest, best = -1, until
        i = s.bucket[int(current) & (s.bucket.size - 1)]
        while i >= 0:
            follower = s.link[i, NEXT]
            time = s.body[i, EVENT]
            if time * s.inverse_width >= current + 1:
                remove(s, i)
                insert(s, i)
            elif time <= s.clock[0]:  # none can be earlier; many are at the start, on a lattice
                return i
            elif time <= best:
                earliest, best = i, time
            i = follower
        if earliest >= 0 or current >= last:
            return earliest
        s.clock[1] = current + 1
        if s.large:
            look_ahead(s)


first = inlined(first)
