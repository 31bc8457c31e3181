"""The MPC method as published, in numpy, written to be read beside the paper.

Each module is one noun of tabatabaei-2009, chapter 3; `ReferenceEngine` puts them in order.
"""

from srd_driver.reference.engine import ReferenceEngine
from srd_driver.reference.faults import SimulationFault

__all__ = ["ReferenceEngine", "SimulationFault"]
