"""Hard spheres by events in a plain loop: the readable truth for small systems.

After every event each pair and each wall is asked when it comes next, at a cost of N^2.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class Contact:
    """One event: particle i meets particle j, or (j = None) the wall at a side of an axis."""

    time: float
    i: int
    j: int | None
    axis: int | None = None
    side: int | None = None


class BruteForce:
    """Equal hard spheres of mass 1; the arguments are those of `HardSpheres`.

    Attributes:
        time: simulated time.
        positions: unwrapped, (N, d).
        velocities: (N, d).
        contacts: all events so far.
    """

    def __init__(
        self,
        positions: ArrayLike,
        velocities: ArrayLike,
        lengths: ArrayLike,
        walls: Sequence[int] = (),
        diameter: float = 1.0,
    ) -> None:
        self.time = 0.0
        self.positions: Array = np.array(positions, dtype=float)
        self.velocities: Array = np.array(velocities, dtype=float)
        self.contacts: list[Contact] = []
        self._lengths: Array = np.array(lengths, dtype=float)
        self._periodic = np.array([axis not in walls for axis in range(len(self._lengths))])
        self._walls = tuple(walls)
        self._diameter = diameter

    def advance(self, until: float) -> None:
        """All events up to the time `until`, in order."""
        while True:
            event = self._next()
            if event.time > until:
                break
            self._fly(event.time)
            if event.i >= 0:
                self._bounce(event)
                self.contacts.append(event)
        self._fly(until)

    def _fly(self, time: float) -> None:
        self.positions += self.velocities * (time - self.time)
        self.time = time

    def _nearest_image(self, i: int, j: int) -> Array:
        r: Array = self.positions[j] - self.positions[i]
        turns = np.where(self._periodic, np.round(r / self._lengths), 0.0)
        return np.asarray(r - self._lengths * turns)

    def _next(self) -> Contact:
        """The earliest contact; flights beyond half a box are stopped there and looked at again."""
        first = Contact(self.time + self._safe_flight(), -1, None)
        for i in range(len(self.positions)):
            for j in range(i + 1, len(self.positions)):
                time = self.time + self._contact_time(i, j)
                if time < first.time:
                    first = Contact(time, i, j)
            for axis in self._walls:
                velocity = self.velocities[i, axis]
                if velocity == 0:
                    continue
                side = int(velocity > 0)
                wall = self._lengths[axis] - self._diameter / 2 if side else self._diameter / 2
                time = self.time + max((wall - self.positions[i, axis]) / velocity, 0.0)
                if time < first.time:
                    first = Contact(time, i, None, axis, side)
        return first

    def _safe_flight(self) -> float:
        """A time in which no nearest image becomes another one's and then a contact."""
        room = np.append(self._lengths[self._periodic], np.inf).min() / 2 - self._diameter
        return float(room / (2 * np.abs(self.velocities).max()))

    def _contact_time(self, i: int, j: int) -> float:
        """t = (-b - sqrt(b^2 - u^2 (r^2 - sigma^2))) / u^2, b = r.u."""
        r = self._nearest_image(i, j)
        u = self.velocities[j] - self.velocities[i]
        b = float(r @ u)
        root = b * b - float(u @ u) * (float(r @ r) - self._diameter**2)
        if b >= 0 or root <= 0:
            return math.inf
        return max((-b - math.sqrt(root)) / float(u @ u), 0.0)

    def _bounce(self, event: Contact) -> None:
        if event.j is not None:
            r = self._nearest_image(event.i, event.j)
            u = self.velocities[event.j] - self.velocities[event.i]
            change = r * float(r @ u) / float(r @ r)
            self.velocities[event.i] += change
            self.velocities[event.j] -= change
        elif event.axis is not None:
            self.velocities[event.i, event.axis] *= -1
