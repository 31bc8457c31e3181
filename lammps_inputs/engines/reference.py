"""The numpy engine of `srd_driver/reference`: it writes no deck."""

from collections.abc import Iterator
from typing import ClassVar

from lammps_inputs.engines.engine import Engine
from lammps_inputs.engines.force_coupling import force_problems
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import FLUID_AVERAGES, SHEARED_AVERAGES, System, VelocityVerlet


class Reference(Engine):
    """Readable truth for small systems."""

    name: ClassVar[str] = "reference"
    processes = False
    pair_potentials = (RepulsiveMie, Dlvo)
    wall_potentials = (IntegratedWall, HarmonicWall)
    motions = (VelocityVerlet,)
    couplings = ("force", "reflection", "cell")

    def problems(self, system: System) -> Iterator[str]:
        yield from self.needs_solvent(system)
        yield from self.unknown_parts(system)
        if system.solvent and system.solvent.coupling != "force":
            yield from self._suspension_problems(system)
            return
        yield from self.needs_slit_or_periodic(system)
        yield from self.no_moving_walls(system)
        yield from self.no_balanced_drives(system)
        yield from self.what_single_has_not(system)
        yield from self.needs_known_tables(system, FLUID_AVERAGES.columns)
        for interaction in system.interactions:
            if isinstance(interaction.potential, Dlvo):
                yield f"coupling = 'force': engine {self.name} has no DLVO potential with it"
        yield from force_problems(system)

    def _suspension_problems(self, system: System) -> Iterator[str]:
        """Of spheres that reflect the fluid or collide with it."""
        solvent = system.solvent
        assert solvent is not None
        yield from self.needs_walls_or_periodic(system)
        yield from self.needs_known_tables(system, SHEARED_AVERAGES.columns)
        if system.box.dimensions != 3 or len(system.species) != 1 or not system.rotates:
            yield (
                f"coupling = {solvent.coupling!r}: engine {self.name} needs a single species of "
                "spheres in 3D"
            )
        for interaction in system.interactions:
            if not isinstance(interaction.potential, Dlvo):
                yield f"{interaction.potential!r}: engine {self.name} has DLVO between spheres only"
        if solvent.hydrodynamics != "on":
            yield (
                f"hydrodynamics = {solvent.hydrodynamics!r}: engine {self.name} needs 'on' with "
                f"coupling = {solvent.coupling!r}"
            )
        known = ("none", "monte_carlo") if system.walls else ("none", "monte_carlo", "layer")
        if solvent.thermostat not in known:
            yield (
                f"thermostat = {solvent.thermostat!r}: engine {self.name} has {' or '.join(known)} "
                f"only with coupling = {solvent.coupling!r}"
            )


ENGINE = Reference()
