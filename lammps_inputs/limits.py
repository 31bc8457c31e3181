"""Where an MPC fluid runs but is inaccurate: the warnings, from the map of docs/stability.md.

What cannot run at all is refused by the scene or the engine (`problems`).
"""

import math
import os
from collections.abc import Iterator

from lammps_inputs.system import Box, Solvent, System
from lammps_inputs.viscosity import solvent_viscosity

BYTES_PER_PARTICLE = 176.0  # to draw and write an initial state, measured at 2e6 particles
FASTEST = 1e9  # particle updates a second of one process, beyond what any engine does
YEAR = 365 * 86400.0  # seconds

SOUND = 1.0  # speed in an ideal gas that a thermostat keeps at kBT = m_f = 1 [a0/t0]
DENSITY = 1.0  # below, most particles are alone in their cell
KNUDSEN = 0.05  # mean free path over width, above which the fluid is no continuum
TAIL = 0.15  # excess over kinetic theory's viscosity


def memory_problems(system: System) -> Iterator[str]:
    """A line where this machine's memory cannot hold the initial state."""
    particles = system.particles + (system.solvent.particles if system.solvent else 0)
    needed = BYTES_PER_PARTICLE * particles
    available = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if needed > available:
        yield (
            f"{particles:.3g} particles: their initial state needs {needed:.3g} bytes of memory; "
            f"this machine has {available:.3g}"
        )


def time_problems(work: float, processes: int) -> Iterator[str]:
    """A line where so many particle updates would take the fastest engine more than a year."""
    years = work / (FASTEST * processes) / YEAR
    if years > 1:
        yield (
            f"{work:.3g} particle updates: would take {years:.3g} years on {processes} "
            f"{'process' if processes == 1 else 'processes'} at {FASTEST:g} a second"
        )


def solvent_warnings(solvent: Solvent, box: Box) -> Iterator[str]:
    """What will be inaccurate, one line each: field, value and reason."""
    if solvent.density < DENSITY:
        yield (
            f"density = {solvent.density!r}: most fluid particles are alone in their cell, "
            "colliding with nobody; temperatures are 10 % and more too low"
        )
    if solvent.hydrodynamics == "on":
        yield from _mean_free_path(solvent, box)
        yield from _long_time_tail(solvent, box)


def _mean_free_path(solvent: Solvent, box: Box) -> Iterator[str]:
    """The longer of the flight in a collision time and the path on which momentum keeps its way.

    The latter is the kinetic part of the viscosity over the thermal speed.
    """
    tau = solvent.collision_time
    field, value, path = "collision_time", tau, tau
    kinetic = solvent_viscosity(solvent, box.dimensions).kinetic
    if kinetic > tau:
        field, value, path = "angle", solvent.angle, kinetic
    width = box.sizes[1]
    if path > KNUDSEN * width:
        yield (
            f"{field} = {value!r}: the mean free path of {path:.3g} a0 is not short against the "
            f"width {width!r}; above {KNUDSEN:g} of it there is no hydrodynamic flow"
        )


def _long_time_tail(solvent: Solvent, box: Box) -> Iterator[str]:
    """Mode coupling's excess in 2D, kBT ln(L / a0) / (16 pi rho nu): docs/reference.md."""
    if box.dimensions == 3:
        return
    nu = solvent_viscosity(solvent, 2).total
    excess = math.log(max(box.sizes)) / (16 * math.pi * solvent.density * nu**2)
    if excess > TAIL:
        yield (
            f"collision_time = {solvent.collision_time!r}, density = {solvent.density!r}: a fluid "
            f"of so low a viscosity ({nu:.2g}) is more viscous than kinetic theory says, by about "
            f"{excess:.0%} (long-time tail of 2D)"
        )
