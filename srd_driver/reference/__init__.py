"""The MPC method as published, in numpy, written to be read beside the papers.

Each module is one noun of tabatabaei-2009, chapter 3, or of hecht-2005; `ReferenceEngine` puts the
first in order, `SuspensionEngine` the second, `SingleEngine` the first in single precision.
"""

from srd_driver.reference.engine import ReferenceEngine
from srd_driver.reference.faults import SimulationFault
from srd_driver.reference.single_engine import SingleEngine
from srd_driver.reference.suspension_engine import SuspensionEngine

__all__ = ["ReferenceEngine", "SimulationFault", "SingleEngine", "SuspensionEngine"]
