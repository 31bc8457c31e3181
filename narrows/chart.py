"""The measured chart of accuracy against run time: which settings are right, and which are fast.

`chart.json` is written by `python benchmarks/pareto.py --chart narrows/chart.json`; docs/pareto.md
shows the same numbers. Its states are those of the benchmark: what a setting does to another system
is an extrapolation.
"""

import json
import math
from collections.abc import Collection, Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import BaseModel, ConfigDict

FLUID = {"density", "collision_time"}  # fields that make another fluid
CERTAIN = 2  # standard errors from 0 of a deviation that is there


class ChartedSetting(BaseModel):
    """A setting of a scene, and how right and how fast it is for a quantity.

    Attributes:
        scene, quantity, engine: by name.
        fields: that differ from the scene of the benchmark.
        deviation, deviation_error: from the truth, relative.
        error_after_10_s: statistical, relative, of 10 processor seconds there.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    scene: str
    quantity: str
    engine: str
    fields: dict[str, Any]
    deviation: float
    deviation_error: float
    error_after_10_s: float

    @property
    def is_right(self) -> bool:
        """Whether no deviation was seen."""
        return abs(self.deviation) <= CERTAIN * self.deviation_error

    @property
    def accuracy(self) -> float:
        """To what the setting is known to be right, relative."""
        return max(abs(self.deviation), self.deviation_error)

    @property
    def is_another_fluid(self) -> bool:
        """Whether its fluid is not that of the scene: then numbers are compared as v_s n_f nu."""
        return bool(FLUID.intersection(self.fields))

    def time_to(self, error: float) -> float:
        """Processor seconds on the benchmark's machine to an error with the deviation in it."""
        if error <= self.accuracy:
            return math.inf
        return 10 * self.error_after_10_s**2 / (error**2 - self.accuracy**2)

    def __str__(self) -> str:
        fields = (f"{name}={value}" for name, value in self.fields.items())
        return " ".join([self.engine, *fields])


@cache
def chart() -> tuple[ChartedSetting, ...]:
    """All settings that were measured."""
    content = json.loads(files("narrows").joinpath("chart.json").read_text(encoding="utf-8"))
    return tuple(ChartedSetting(**entry) for entry in content["settings"])


def charted(
    scene: str, quantity: str, engines: Collection[str], fixed: Iterable[str]
) -> list[ChartedSetting]:
    """Settings of a quantity by these engines, which change none of the fixed fields."""
    kept = set(fixed)
    return [
        each
        for each in chart()
        if (each.scene, each.quantity) == (scene, quantity)
        and each.engine in engines
        and not kept.intersection(each.fields)
    ]


def best(settings: Iterable[ChartedSetting], error: float) -> ChartedSetting | None:
    """The one that is first at a relative error; where none is known to be so right, the fastest
    of those without a deviation. None of none."""
    known = list(settings)
    if reaching := [each for each in known if each.time_to(error) < math.inf]:
        return min(reaching, key=lambda each: each.time_to(error))
    right = [each for each in known if each.is_right]
    return min(right, key=lambda each: each.error_after_10_s, default=None)
