"""A system of the laboratory beside the scene that stands for it: what is kept, what is changed."""

import math
from dataclasses import dataclass

WATER_SOUND = 1.5e3  # [m/s]
WATER_SELF_DIFFUSION = 2.3e-9  # of its molecules at 300 K [m^2/s]
WATER_MOLECULE = 3e-10  # what stands for a mean free path in a liquid [m]
KEPT = 1e-6  # relative change that still is none


@dataclass(frozen=True)
class Row:
    """A quantity in the laboratory and in the simulation; both in the unit, which is SI."""

    name: str
    symbol: str
    unit: str
    real: float
    simulated: float

    @property
    def change(self) -> str:
        """`kept`, or the factor from the laboratory to the simulation."""
        if self.real == self.simulated or abs(self.simulated - self.real) < KEPT * abs(self.real):
            return "kept"
        if not (math.isfinite(self.real) and math.isfinite(self.simulated) and self.real):
            return "changed"
        return f"x {self.simulated / self.real:.3g}"


@dataclass(frozen=True)
class Laboratory:
    """What a system of the laboratory becomes.

    Attributes:
        rows: of the table.
        units: a0 [m], t0 [s], m_f [kg] and kBT [J] of the simulation.
        warnings: what is lost, one line each.
    """

    rows: tuple[Row, ...]
    units: dict[str, float]
    warnings: tuple[str, ...]
