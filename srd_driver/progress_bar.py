"""How far a simulation is, while it runs: a bar on a terminal, else lines."""

import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from srd_driver.simulation import Simulation

LINE_SECONDS = 30.0  # between two lines, and before the first


@contextmanager
def progress_bar(simulation: "Simulation") -> Iterator[Callable[["Simulation"], None]]:
    """What `Simulation.run` and `finish` are to call; shows rate and mean velocity since now.

    Of processes under mpirun the first one shows it.
    """
    pace = _Pace(simulation)
    console = Console(stderr=True)
    if simulation.rank != 0:
        yield pace.follow
        return
    if not console.is_terminal:
        yield _Lines(pace, renewed=console.is_jupyter).report
        return
    with Progress(
        TextColumn(simulation.scene.name, markup=False),
        BarColumn(),
        TextColumn("{task.completed:.0f} of {task.total:.0f} t0"),
        TextColumn("{task.description}"),
        TimeRemainingColumn(),
        console=console,
    ) as progress:
        task = progress.add_task("", total=simulation.scene.system.clock.end)
        yield lambda now: progress.update(task, completed=now.time, description=pace.told(now))


class _Pace:
    """Simulated time a second, and the mean velocity of the particles, since the start."""

    def __init__(self, simulation: "Simulation") -> None:
        self._moving = bool(simulation.scene.system.species)
        self._began = clock.perf_counter()
        self._time = simulation.time
        self._position = simulation.mean_colloid_position() if self._moving else 0.0

    def told(self, now: "Simulation") -> str:
        time = now.time - self._time
        text = f"{time / max(clock.perf_counter() - self._began, 1e-3):.3g} t0/s"
        if self._moving:
            speed = (now.mean_colloid_position() - self._position) / time
            text += f", moving at {speed:+.4f} a0/t0"
        return text

    def follow(self, now: "Simulation") -> None:
        """Take part in what the first process tells: the mean velocity is of all."""
        self.told(now)


class _Lines:
    """For pipes and logs of queues; in a notebook a single line that is renewed."""

    def __init__(self, pace: _Pace, renewed: bool) -> None:
        self._pace = pace
        self._renewed = renewed
        self._said = clock.monotonic()

    def report(self, now: "Simulation") -> None:
        told = self._pace.told(now)
        if self._renewed or clock.monotonic() - self._said >= LINE_SECONDS:
            self._said = clock.monotonic()
            line = f"{now.time:.0f} of {now.scene.system.clock.end:.0f} t0, {told}"
            end = "\r" if self._renewed else "\n"
            print(line, end=end, file=sys.stderr, flush=True)
