"""The numpy engine of `srd_driver/reference`: it writes no deck."""

from collections.abc import Iterator
from typing import ClassVar

from lammps_inputs.engines.engine import Engine
from lammps_inputs.engines.force_coupling import force_problems
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import FLUID_AVERAGES, System, VelocityVerlet


class Reference(Engine):
    """Readable truth for small systems."""

    name: ClassVar[str] = "reference"
    processes = False
    pair_potentials = (RepulsiveMie,)
    wall_potentials = (IntegratedWall,)
    motions = (VelocityVerlet,)

    def problems(self, system: System) -> Iterator[str]:
        yield from self.needs_solvent(system)
        yield from self.unknown_parts(system)
        yield from self.needs_slit_or_periodic(system)
        yield from self.no_moving_walls(system)
        yield from self.no_balanced_drives(system)
        yield from self.needs_known_tables(system, FLUID_AVERAGES.columns)
        yield from force_problems(system)


ENGINE = Reference()
