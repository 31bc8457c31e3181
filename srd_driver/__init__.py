"""Run scenes from Python: sessions, progress, checkpoints, and the numpy reference engine."""

from srd_driver.errors import RunError
from srd_driver.simulation import Simulation

__all__ = ["RunError", "Simulation"]
