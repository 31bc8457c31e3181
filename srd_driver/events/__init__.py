"""Event-driven hard spheres with colours; docs/events.md says how it works and what it promises."""

from srd_driver.events.engine import HardSpheres, PairReactions, WallReactions
from srd_driver.events.errors import EventError
from srd_driver.events.profiles import Profile

__all__ = ["EventError", "HardSpheres", "PairReactions", "Profile", "WallReactions"]
