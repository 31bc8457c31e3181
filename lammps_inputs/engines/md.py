"""Plain molecular dynamics by LAMMPS's own styles: species without a solvent."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import ClassVar

from lammps_inputs.engines import lammps, soft_particles
from lammps_inputs.engines.engine import LammpsEngine, Start
from lammps_inputs.initial_state import InitialState
from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.pseudo_hard import PseudoHard
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import SIZES, DissipativePairs, Langevin, System, VelocityVerlet

SKIN = 0.3  # of the neighbour list [a0]
LISTS = "fix lists all balance ${sample} 1e9 shift x 1 1.1"

EXPRESSIONS = {
    "temperature": "c_thermo_temp",
    "mean_velocity_x": "vcm(all,x)",
}


class MolecularDynamics(LammpsEngine):
    """Newton's equations, or those of a thermostat, of particles alone."""

    name: ClassVar[str] = "md"
    pair_potentials = (RepulsiveMie, PseudoHard, *soft_particles.POTENTIALS)
    wall_potentials = (IntegratedWall, HarmonicWall)
    motions = (VelocityVerlet, *soft_particles.MOTIONS)
    rests = True

    def needs_plugin(self, system: System) -> bool:
        return soft_particles.needs_plugin(system)

    def problems(self, system: System) -> Iterator[str]:
        if system.solvent:
            yield f"engine = {self.name!r}: it has no fluid, and the scene needs one"
        if not system.particle_interactions():
            yield f"engine = {self.name!r}: the scene has no interacting particles"
        yield from self.unknown_parts(system)
        yield from lammps.one_pair_style(system)
        yield from soft_particles.problems(system)
        for axis, periodic in enumerate(system.box.periodic):
            sides = sorted(wall.side for wall in system.walls_on(axis) if wall.potentials)
            if not periodic and sides != ["lower", "upper"]:
                yield f"walls across the {SIZES[axis]}: one on either side must repel particles"
        yield from self.needs_known_tables(system, _expressions(system))
        for output in system.outputs:
            if output.kind == "profile":
                yield f"{output.file}: engine {self.name} writes no profile"

    def atoms(self, system: System, start: Start) -> Iterator[str]:
        yield "atom_modify sort 0 0.0 # the order of the atoms decides the last bit of sums"
        yield from lammps.read(start)
        if not start.checkpoint:
            yield from lammps.groups(system)

    def interactions(self, system: System) -> Iterator[str]:
        yield from lammps.pairs(system, soft_particles.dissipative_style(system))
        yield from soft_particles.dissipative_pairs(system)
        yield f"pair_modify {system.particle_interactions()[0].potential.pair_modify}"
        yield f"neighbor {SKIN!r} bin"
        yield "neigh_modify delay 0 every 1 check yes"
        yield "# when lists are built shows in last digits: as at checkpoints, so at each output"
        yield f"{LISTS} # never that imbalanced"

    def preparation(self, system: System, start: Start) -> Iterator[str]:
        if not start.checkpoint:
            yield from soft_particles.preparation(system)
        if system.shear_rate:
            yield from soft_particles.kept_places()

    def renewal(self, system: System) -> Sequence[str]:
        commands = list[str]()
        if isinstance(system.motion, Langevin):
            commands.append(soft_particles.langevin_noise(system.motion))
        if isinstance(system.motion, DissipativePairs):
            commands += [line for line in self.interactions(system) if line.startswith("pair_")]
        if system.shear_rate:
            commands.append(soft_particles.PUT_BACK)
        return (*commands, "unfix lists", LISTS) if commands else ()

    def motion(self, system: System) -> Iterator[str]:
        yield from soft_particles.motion(system)
        if system.box.dimensions == 2:
            yield "fix plane all enforce2d"
        for name, species, potential, faces in lammps.wall_faces(system):
            if isinstance(potential, IntegratedWall):
                yield potential.table_fix(name, species, faces, f"{name}.table")
            else:
                assert isinstance(potential, HarmonicWall), "problems() has checked it"
                yield potential.wall_fix(name, species, faces)
        yield from lammps.drives(system)

    def averages(self, system: System, start: Start) -> Iterator[str]:
        yield from soft_particles.computes(system)
        yield "# output, averaged over each sampling interval"
        for output in system.outputs:
            if output.kind == "table":
                for column in output.columns:
                    yield f"variable {column} equal {_expressions(system)[column]}"

    def write(self, system: System, state: InitialState, title: str, directory: Path) -> None:
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            about = f"initial particles of the scene {title}"
            file.writelines(lammps.particle_data(system, state, about))
        for name, _, potential, _ in lammps.wall_faces(system):
            if isinstance(potential, IntegratedWall):
                (directory / f"{name}.table").write_text(potential.table_text(), encoding="utf-8")


def _expressions(system: System) -> dict[str, str]:
    return EXPRESSIONS | soft_particles.expressions(system)


ENGINE = MolecularDynamics()
