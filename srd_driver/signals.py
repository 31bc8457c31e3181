"""Signals that end a run or a sweep in order, with what is done so far kept."""

import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

from srd_driver.simulation import Simulation

STOP = (signal.SIGINT, signal.SIGTERM)  # Ctrl-C, or a queueing system's end of time
WAYS_OUT = (signal.SIGTERM, signal.SIGHUP)  # or a closed terminal


@contextmanager
def handled(numbers: Sequence[signal.Signals], handler: Callable[[int], None]) -> Iterator[None]:
    """Call the handler with the number of the first signal of each kind that comes."""

    def handle(number: int, _: FrameType | None) -> None:
        signal.signal(number, before[signal.Signals(number)])  # a second one: at once
        handler(number)

    before = {number: signal.signal(number, handle) for number in numbers}
    try:
        yield
    finally:
        for number, handler_before in before.items():
            signal.signal(number, handler_before)


def stopped_by_signals(simulation: Simulation) -> AbstractContextManager[None]:
    """The first Ctrl-C or SIGTERM: a checkpoint, then the end; a second one: at once."""
    return handled(STOP, lambda _: simulation.stop())


def interrupted_by_signals() -> AbstractContextManager[None]:
    """A queueing system's SIGTERM, or a closed terminal, is a Ctrl-C."""

    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    return handled(WAYS_OUT, interrupt)
