"""What the simulation asks of an engine while it runs in its run directory."""

from typing import Any, Protocol

from lammps_inputs.system import Array
from run_files.fluid_file import Fluid


class Session(Protocol):
    """One engine at work; each file it writes is described in docs/run-directory.md.

    Colloids are the particles of all species.
    """

    step: int
    suffix: str  # of its checkpoint files
    lammps: Any  # the object at work; None for an engine that is none of LAMMPS

    @property
    def colloid_positions(self) -> Array:
        """Centres of the colloids of this process, (n, d), wrapped into the box: a view [a0]."""

    @property
    def colloid_velocities(self) -> Array:
        """Velocities of the colloids of this process, (n, d): a view [a0/t0]."""

    def fluid(self) -> Fluid:
        """A copy of the whole solvent, which there is; called by every process."""

    def mean_colloid_position(self) -> float:
        """Mean unwrapped x of all colloids [a0]."""

    def advance(self, steps: int) -> None:
        """Run whole sampling intervals, writing output."""

    def save(self, file: str) -> None:
        """Write a checkpoint into the run directory; under MPI, called by every process."""

    def close(self) -> None:
        """Release the engine."""
