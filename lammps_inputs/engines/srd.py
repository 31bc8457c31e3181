"""The decks of LAMMPS's own `fix srd`: the fluid is LAMMPS atoms that have no neighbours."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import ClassVar

import numpy as np

from lammps_inputs.engines import lammps
from lammps_inputs.engines.engine import LammpsEngine, Start
from lammps_inputs.initial_state import InitialState
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import (
    FLUID,
    FLUID_AVERAGES,
    SIZES,
    SUSPENSION_AVERAGES,
    Drive,
    Solvent,
    System,
    VelocityVerlet,
)

SEED_STREAM = 90  # Philox key of the seeds handed to fix srd, one block per start


class Srd(LammpsEngine):
    """The standard method: hard collisions in place of the forces between species and fluid."""

    name: ClassVar[str] = "srd"
    pair_potentials = (RepulsiveMie, Dlvo)
    wall_potentials = (IntegratedWall,)
    motions = (VelocityVerlet,)
    couplings = ("force", "reflection")

    def problems(self, system: System) -> Iterator[str]:
        yield from self.needs_solvent(system)
        yield from self.unknown_parts(system)
        yield from self.needs_slit_or_periodic(system)
        yield from self.no_moving_walls(system)
        known = SUSPENSION_AVERAGES if system.rotates else FLUID_AVERAGES
        yield from self.needs_known_tables(system, known.columns)
        yield from lammps.one_pair_style(system)
        fluid = system.solvent
        if fluid is None:
            return
        if fluid.angle != 90:
            yield f"angle = {fluid.angle!r}: fix srd rotates by 90 degrees only"
        if fluid.precision != "double":
            yield f"precision = {fluid.precision!r}: fix srd has double only"
        if fluid.hydrodynamics != "on":
            given = fluid.hydrodynamics
            yield f"hydrodynamics = {given!r}: fix srd cannot switch them off; must be 'on'"
        if fluid.thermostat not in ("none", "layer"):
            yield (
                f"thermostat = {fluid.thermostat!r}: fix srd rescales (layer) or does nothing "
                "(none)"
            )
        for name, size in zip(SIZES, system.box.sizes, strict=False):
            if size != round(size):
                yield f"{name} = {size!r}: fix srd needs a whole number of collision cells"
        if system.box.dimensions == 3 and fluid.rotation != "coordinate_axes":
            yield f"rotation = {fluid.rotation!r}: fix srd rotates about the coordinate_axes only"
        for species in system.species:
            meets = fluid.coupling == "reflection" or species.name in system.fluid_interactions()
            if not meets or not species.radius:
                yield f"{species.name}: fix srd needs them to have a radius, and to meet the fluid"

    def warnings(self, system: System) -> Iterator[str]:
        if system.solvent and system.solvent.thermostat == "none":
            yield (
                "thermostat = 'none': fix srd cuts speeds and so cools the fluid slowly, by 10 % "
                "in 1000 collisions"
            )

    def seeds(self, seed: int, step: int) -> dict[str, int]:
        """A resumed run must not repeat its random numbers."""
        words = np.random.Philox(key=[seed, SEED_STREAM], counter=[step, 0, 0, 0])
        collision, shift = (int(word % 900_000_000) + 1 for word in words.random_raw(2))
        return {"seed_collision": collision, "seed_shift": shift}

    def atoms(self, system: System, start: Start) -> Iterator[str]:
        if not system.species:
            yield "atom_style atomic"
            yield "atom_modify sort 100 1.0"
            yield from lammps.read(start)
            if not start.checkpoint:
                yield "group fluid type 1"
            return
        group = lammps.particle_group(system)
        yield "atom_style sphere"
        yield f"atom_modify first {group}"
        yield from lammps.read(start)
        if start.checkpoint:
            yield f"atom_modify first {group}"
            return
        yield from lammps.groups(system)
        yield f"group fluid type {len(system.species) + 1}"
        for species in system.species:
            yield f"set group {species.name} mass {species.mass!r}"

    def interactions(self, system: System) -> Iterator[str]:
        if not system.species:
            yield "# the fluid has no neighbours and no ghosts"
            yield "pair_style none"
            yield "neighbor 0.0 bin"
            yield "neigh_modify delay 0 every 1 check no"
            yield "comm_modify vel yes cutoff 0.0"
            yield ""
            return
        group = lammps.particle_group(system)
        yield f"# only {group} have neighbours and ghosts: the fluid meets them inside fix srd"
        yield "neighbor 0.1 multi"
        yield f"neigh_modify delay 0 every 1 check yes include {group}"
        yield f"comm_modify mode multi group {group} vel yes"
        yield ""
        yield from lammps.pairs(system, seed="${seed_collision}")
        first = system.particle_interactions()[0].potential
        yield first.no_pair_coeff(f"* {len(system.species) + 1}")
        yield f"pair_modify {first.pair_modify}"
        yield ""

    def motion(self, system: System) -> Iterator[str]:
        if system.species:
            disc = " disc" if system.box.dimensions == 2 else ""
            yield f"fix motion {lammps.particle_group(system)} nve/sphere{disc}"
        for name, species, potential, faces in lammps.wall_faces(system):
            assert isinstance(potential, IntegratedWall), "problems() has checked it"
            yield potential.table_fix(name, species, faces, f"{name}.table")
        yield from lammps.drives(system)
        for drive in system.drives_on(FLUID):
            for part, axis in zip(drive.direction, "xyz", strict=True):
                if part:
                    factor = "" if part == 1 else f"{part!r}*"
                    name = drive.variable if axis == "x" else f"{drive.variable}_{axis}"
                    pulled = "pulled" if axis == "x" else f"pulled_{axis}"
                    yield f"variable {pulled} atom v{axis}+{factor}v_{drive.variable}*dt"
                    yield (
                        f"fix {name} fluid set 1 0 group fluid v{axis} v_{pulled} "
                        "# fix srd ignores forces"
                    )
        for drive in system.drives:
            if drive.balanced:
                yield from _balance(drive)
        if system.solvent and system.solvent.drift_interval:
            steps = system.solvent.drift_interval * system.clock.steps_per_collision
            yield f"fix drift all momentum {steps} linear 1 1 1"

    def solvent(self, system: System, start: Start) -> Iterator[str]:
        yield "# the MPC solvent; fix srd knows hard collisions with colloids and walls only"
        if system.walls:
            yield "fix edges all wall/srd ylo EDGE yhi EDGE"
        options = ["shift yes ${seed_shift}"]
        if system.walls or system.species:
            options.append("collision noslip")
        if _fluid(system).thermostat != "none":
            options.append("tstat yes")
        if system.species:
            options.append("overlap no inside ignore search 0.5 cubic warn 0.01")
        colloids = lammps.particle_group(system) if system.species else "NULL"
        yield (
            f"fix solvent fluid srd {system.clock.steps_per_collision} {colloids} 1.0 1.0 "
            "${seed_collision} " + " ".join(options)
        )

    def averages(self, system: System, start: Start) -> Iterator[str]:
        width = system.box.sizes[1]
        bins = 2 * round(width)
        file = "append" if start.checkpoint else "file"
        yield "# output: fluid by half-cell bins along y, averaged over each sampling interval"
        yield f"compute layers fluid chunk/atom bin/1d y lower {width / bins!r} units box"
        yield (
            f"fix profile fluid ave/chunk {lammps.window(system)} layers density/number vx temp "
            f"{file} fluid_profile.dat"
        )
        yield f"compute thermal fluid temp/profile 1 0 0 y {bins}"
        yield "variable fluid_temperature equal c_thermal"
        yield "variable mean_velocity_x equal vcm(all,x)"
        if system.rotates:
            yield "variable mean_velocity_z equal vcm(all,z)"
            yield "variable fluid_velocity_x equal vcm(fluid,x)"
            yield "variable fluid_velocity_z equal vcm(fluid,z)"
            yield from _moments()
            yield from lammps.rotational_temperature(system)

    def write(self, system: System, state: InitialState, title: str, directory: Path) -> None:
        with (directory / "state.data").open("w", encoding="utf-8") as file:
            file.writelines(_data(system, state, title))
        for name, _, potential, _ in lammps.wall_faces(system):
            assert isinstance(potential, IntegratedWall), "problems() has checked it"
            (directory / f"{name}.table").write_text(potential.table_text(), encoding="utf-8")


def _balance(drive: Drive) -> Iterator[str]:
    """What the fluid gets so that total momentum stays what it is."""
    for part, axis in zip(drive.direction, "xyz", strict=True):
        if part:
            name = f"balance_{drive.variable}_{axis}"
            share = f"{-part!r}*v_{drive.variable}*dt*mass({drive.target})/count(fluid)"
            yield f"variable {name} atom v{axis}+{share}"
            yield f"fix {name} fluid set 1 0 group fluid v{axis} v_{name}"


def _moments() -> Iterator[str]:
    """Skewness and excess kurtosis of the fluid's velocities along each axis."""
    for axis in "xyz":
        for power in (2, 3, 4):
            yield f"variable v{axis}{power} atom (v{axis}-vcm(fluid,{axis}))^{power}"
        powers = " ".join(f"v_v{axis}{power}" for power in (2, 3, 4))
        yield f"compute v{axis} fluid reduce ave {powers}"
        second, third, fourth = (f"c_v{axis}[{number}]" for number in (1, 2, 3))
        yield f"variable fluid_skewness_{axis} equal {third}/{second}^1.5"
        yield f"variable fluid_kurtosis_{axis} equal {fourth}/{second}^2-3"


def _fluid(system: System) -> Solvent:
    assert system.solvent is not None, "problems() has checked it"
    return system.solvent


def _data(system: System, state: InitialState, title: str) -> Iterable[str]:
    """The data file: the initial state, species first."""
    fluid = len(state.fluid_positions)
    atoms = system.particles + fluid
    fluid_type = len(system.species) + 1
    yield from lammps.data_header(
        system, f"initial state of the scene {title}", atoms, types=fluid_type
    )
    if system.species:
        sizes = [2 * radius for radius in system.radii.tolist()]
        types = system.atom_types()
        kinds = [f"{kind} {size!r} 1.0" for kind, size in zip(types, sizes, strict=True)]
        kinds += [f"{fluid_type} 0.0 1.0"] * fluid
        spin = " 0 0 0"
        yield "\nAtoms # sphere\n\n"
    else:
        kinds = ["1"] * fluid
        spin = ""
        yield "\nMasses\n\n1 1.0\n"
        yield "\nAtoms # atomic\n\n"
    positions = np.concatenate([state.colloid_positions, state.fluid_positions])
    velocities = np.concatenate([state.colloid_velocities, state.fluid_velocities])
    for i, (kind, row) in enumerate(zip(kinds, positions.tolist(), strict=True), start=1):
        yield f"{i} {kind} {lammps.coordinates(row)}\n"
    yield "\nVelocities\n\n"
    for i, row in enumerate(velocities.tolist(), start=1):
        yield f"{i} {lammps.coordinates(row)}{spin}\n"


ENGINE = Srd()
