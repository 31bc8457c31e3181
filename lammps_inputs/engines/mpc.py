"""The decks of our `fix mpc`: the fluid lives in the fix, LAMMPS's atoms are the species."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

import numpy as np

from lammps_inputs.engines import lammps, soft_particles
from lammps_inputs.engines.engine import LammpsEngine, Start
from lammps_inputs.engines.force_coupling import force_problems
from lammps_inputs.initial_state import InitialState
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import (
    FLOW,
    FLUID,
    FLUID_AVERAGES,
    SHEARED_AVERAGES,
    SUSPENSION_AVERAGES,
    Drive,
    Solvent,
    Species,
    System,
    VelocityVerlet,
)

SKIN = 0.5  # least of the neighbour list, of colloids that feel the fluid by forces [a0]
LONGEST_SKIN = 0.85  # of others [a0]
USUAL_LISTS = 2  # most that are built in a collision interval, unless the skin asks for more
SLOW = 0.1  # drift of species that the fluid carries, at least [a0/t0]
FLIGHTS = 10  # collision times of free fall that such a drift comes to, at most


class Mpc(LammpsEngine):
    """The hybrid as published, and the fastest."""

    name: ClassVar[str] = "mpc"
    plugin = True
    pair_potentials = (RepulsiveMie, Dlvo, *soft_particles.POTENTIALS)
    wall_potentials = (IntegratedWall, HarmonicWall)
    motions = (VelocityVerlet,)
    rests = True
    couplings = ("force", "reflection", "cell")
    tells_flow = True
    scales = True

    def problems(self, system: System) -> Iterator[str]:
        yield from self.needs_solvent(system)
        yield from self.unknown_parts(system)
        yield from self.needs_walls_or_periodic(system)
        of_spheres = SHEARED_AVERAGES if system.walls_on(2) else SUSPENSION_AVERAGES
        known = of_spheres if system.rotates else FLUID_AVERAGES
        known_columns = {*known.columns, *soft_particles.expressions(system)}
        yield from self.needs_known_tables(system, known_columns)
        yield from lammps.one_pair_style(system)
        yield from force_problems(system)
        yield from self.what_single_has_not(system)
        fluid = system.solvent
        if (
            fluid
            and fluid.thermostat == "layer"
            and sum(not way for way in system.box.periodic) > 1
        ):
            yield ("thermostat = 'layer': there must not be two pairs of walls; use 'monte_carlo'")

    def atoms(self, system: System, start: Start) -> Iterator[str]:
        if system.rotates:
            yield "atom_style sphere"
        yield "atom_modify sort 0 0.0 # the order of the atoms decides the last bit of sums"
        yield from lammps.read(start)
        if not start.checkpoint:
            yield from lammps.groups(system)
            if system.rotates:
                for species in system.species:
                    yield f"set group {species.name} mass {species.mass!r}"

    def interactions(self, system: System) -> Iterator[str]:
        ghosts = _ghost_cutoff(system)
        if not system.particle_interactions():
            yield "pair_style none"
            if system.species:
                yield from _lists_at_collisions(system)
            yield f"comm_modify cutoff {max(1.0, ghosts)!r}"
            return
        between = system.particle_interactions()
        yield from lammps.pairs(system)
        yield f"pair_modify {system.particle_interactions()[0].potential.pair_modify}"
        travel = 2 * max(_travel(system, each) for each in system.species)
        lists = _lists(system, travel)
        skin = max(travel / lists, SKIN if _fluid(system).coupling == "force" else 0.0)
        yield f"neighbor {skin:.6g} bin"
        yield from _lists_at_collisions(system, lists)
        if ghosts > skin + max(i.potential.cutoff for i in between):
            yield f"comm_modify cutoff {ghosts:.6g} # the fluid sees {_group(system)} so far"
        if any(i.potential.dissipates for i in between):
            yield "comm_modify vel yes"

    def preparation(self, system: System, start: Start) -> Iterator[str]:
        if not start.checkpoint:
            yield from soft_particles.preparation(system)

    def motion(self, system: System) -> Iterator[str]:
        if system.species:
            yield f"fix motion {_group(system)} {'nve/sphere' if system.rotates else 'nve'}"
        for name, species, potential, faces in lammps.wall_faces(system):
            assert isinstance(potential, IntegratedWall | HarmonicWall), "problems() has checked it"
            yield potential.wall_fix(name, species, faces)
        yield from lammps.drives(system)

    def solvent(self, system: System, start: Start) -> Iterator[str]:
        fluid = _fluid(system)
        clock = system.clock
        options = ["load state.fluid", f"density {fluid.density!r}", f"angle {fluid.angle!r}"]
        if system.box.dimensions == 3:
            options.append(f"axis {fluid.rotation.partition('_')[0]}")
        options += [f"tstat {fluid.thermostat}", f"hydro {fluid.hydrodynamics}"]
        if fluid.precision != "double":
            options.append(f"precision {fluid.precision}")
        for drive in system.drives_on(FLUID):
            options.append(f"field {' '.join(_component(drive, way) for way in drive.direction)}")
        types = system.types()
        for species, potential in system.fluid_interactions().items():
            assert isinstance(potential, RepulsiveMie), "problems() has checked it"
            options.append(f"force {types[species]} {potential.epsilon!r} {potential.sigma!r}")
        if fluid.coupling == "reflection":
            for each in system.species:
                options.append(f"reflect {types[each.name]} {each.radius!r} entry")
        elif fluid.coupling == "cell":
            options.append("collide yes")
        for drive in system.drives:
            if drive.balanced:
                ways = " ".join(_component(drive, way) for way in drive.direction)
                options.append(f"compensate {ways}")
        if fluid.drift_interval:
            options.append(f"momentum {fluid.drift_interval}")
        for wall in system.walls:
            if any(wall.velocity):
                ways = " ".join(map(repr, wall.velocity[: system.box.dimensions]))
                options.append(f"wall {'xyz'[wall.axis]}{lammps.FACES[wall.side]} {ways}")
        mode = "append" if start.checkpoint else "file"
        options.append(f"bins {profile_bins(system)}")
        options.append(f"profile {clock.look_steps} ${{sample}} {mode} fluid_profile.dat")
        if system.flow:
            grid = " ".join(map(str, system.flow.bins))
            every = f"{clock.look_steps} $(v_sample*{system.flow.samples})"
            options.append(f"flow {every} {grid} {system.flow.around or 'lab'} {mode} {FLOW.file}")
        coupled = _group(system) if system.coupled else "NULL"
        yield "# the MPC solvent"
        yield (
            f"fix solvent all mpc {clock.steps_per_collision} {coupled} {fluid.temperature!r} "
            f"{fluid.cell!r} ${{seed}} " + " ".join(options)
        )

    def averages(self, system: System, start: Start) -> Iterator[str]:
        yield from soft_particles.computes(system)
        yield "# output, averaged over each sampling interval; the solvent writes its own profile"
        yield "variable fluid_temperature equal f_solvent"
        if system.species:
            group = _group(system)
            momentum = f"(f_solvent[1]+mass({group})*vcm({group},x))"
            yield f"variable mean_velocity_x equal {momentum}/(f_solvent[4]+mass({group}))"
        else:
            yield "variable mean_velocity_x equal f_solvent[1]/f_solvent[4]"
        if system.rotates:
            group = _group(system)
            momentum = f"(f_solvent[3]+mass({group})*vcm({group},z))"
            yield f"variable mean_velocity_z equal {momentum}/(f_solvent[4]+mass({group}))"
            yield "variable fluid_velocity_x equal f_solvent[1]/f_solvent[4]"
            yield "variable fluid_velocity_z equal f_solvent[3]/f_solvent[4]"
            for number, axis in enumerate("xyz", start=6):
                yield f"variable fluid_skewness_{axis} equal f_solvent[{number}]"
                yield f"variable fluid_kurtosis_{axis} equal f_solvent[{number + 3}]"
            if system.walls_on(2):
                yield "variable lower_wall_force_x equal f_solvent[24]"
                yield "variable upper_wall_force_x equal f_solvent[27]"
            yield from lammps.rotational_temperature(system)
        known = soft_particles.expressions(system)
        for output in system.outputs:
            for column in output.columns:
                if output.kind == "table" and column in known:
                    yield f"variable {column} equal {known[column]}"

    def write(self, system: System, state: InitialState, title: str, directory: Path) -> None:
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            about = f"initial colloids of the scene {title}"
            file.writelines(lammps.particle_data(system, state, about))
        (directory / "state.fluid").write_bytes(fluid_file(state))


def profile_bins(system: System) -> int:
    """Bins of half a cell across y."""
    return 2 * round(system.box.sizes[1])


def fluid_file(state: InitialState, collisions: int = 0) -> bytes:
    """The fluid of a state as `fix mpc ... load` reads it (docs/fix_mpc.md)."""
    count, dimensions = state.fluid_positions.shape
    rows = np.column_stack([np.arange(count), state.fluid_positions, state.fluid_velocities])
    header = np.array([dimensions, count, collisions], dtype="<i8")
    return b"mpcfluid" + header.tobytes() + rows.astype("<f8").tobytes()


def _component(drive: Drive, way: float) -> str:
    """A component of an acceleration, from the deck's variable."""
    if way in (0, 1):
        return f"${{{drive.variable}}}" if way else "0"
    return f"$({way!r}*v_{drive.variable}:%.17g)"


def _fluid(system: System) -> Solvent:
    assert system.solvent is not None, "problems() has checked it"
    return system.solvent


def _group(system: System) -> str:
    return lammps.particle_group(system)


def _lists(system: System, travel: float) -> int:
    """How often in a collision interval lists are built, for a skin that is not too long.

    Once where the fluid sees species between collisions.
    """
    if _fluid(system).coupling == "force":
        return 1
    steps = system.clock.steps_per_collision
    divisors = [number for number in range(1, steps + 1) if steps % number == 0]
    usual = max(number for number in divisors if number <= USUAL_LISTS)
    enough = next((number for number in divisors if travel / number <= LONGEST_SKIN), steps)
    return max(usual, enough)


def _lists_at_collisions(system: System, lists: int = 1) -> Iterator[str]:
    """And at fixed steps between: LAMMPS would do it at checkpoints too, and these would show."""
    yield "# when lists are built and places wrapped shows in last digits: at each collision"
    steps = system.clock.steps_per_collision // lists
    yield f"neigh_modify delay 0 every {steps} check no"


def _travel(system: System, species: Species) -> float:
    """How far a particle moves in a collision interval, at most: else fix mpc stops [a0].

    Its speed: a drift, 7 thermal speeds, and 3 that it may gain. The drift is at most 1; between
    walls that move, what does not meet the fluid by forces is no faster than they are.
    """
    fluid = _fluid(system)
    walls = max((max(map(abs, wall.velocity)) for wall in system.walls), default=0.0)
    pulled = max((each.magnitude for each in system.drives_on(species.name)), default=0.0)
    falling = max(SLOW, FLIGHTS * pulled * fluid.collision_time)
    drift = 1 if fluid.coupling == "force" else falling + walls
    thermal = math.sqrt(fluid.temperature / species.mass)
    return fluid.collision_time * (drift + 10 * thermal)


def _ghost_cutoff(system: System) -> float:
    """How far from its cells the fluid has to see species: what fix mpc asks for [a0].

    1.5 cells, the range of the force or the radius, and the flights of one collision interval: 7
    thermal speeds of the fluid, and 3 times the fastest particle's. 0 where the fluid sees none.
    """
    solvent = _fluid(system)
    if solvent.coupling == "cell":
        return 0.0
    forces = system.fluid_interactions()
    reaches = {name: potential.cutoff for name, potential in forces.items()}
    if solvent.coupling == "reflection":
        reaches = {each.name: each.radius for each in system.species}
    flight = 7 * solvent.collision_time
    return max(
        (
            1.5 + reaches[each.name] + flight + 3 * _travel(system, each)
            for each in system.species
            if each.name in reaches
        ),
        default=0.0,
    )


ENGINE = Mpc()
