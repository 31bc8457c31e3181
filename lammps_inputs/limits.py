"""Where an MPC fluid runs but is inaccurate: the warnings, from the map of docs/stability.md.

What cannot run at all is refused by the scene or the engine (`problems`).
"""

import math
from collections.abc import Iterator

from lammps_inputs.system import Box, Solvent
from lammps_inputs.viscosity import solvent_viscosity

SOUND = 1.0  # speed in an ideal gas that a thermostat keeps at kBT = m_f = 1 [a0/t0]
DENSITY = 1.0  # below, most particles are alone in their cell
KNUDSEN = 0.05  # mean free path over width, above which the fluid is no continuum
TAIL = 0.15  # excess over kinetic theory's viscosity


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
