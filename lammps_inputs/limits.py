"""Where a scene runs but is inaccurate: the warnings, from the map of docs/stability.md.

What cannot run at all is refused by the scene itself (`problems`).
"""

import math
from collections.abc import Iterator

from lammps_inputs import Channel, Scene
from lammps_inputs.bulk import Bulk
from lammps_inputs.channel import SOUND
from lammps_inputs.deck import Engine
from lammps_inputs.viscosity import viscosity

DENSITY = 1.0  # below, most particles are alone in their cell
KNUDSEN = 0.05  # mean free path over width, above which the fluid is no continuum
TAIL = 0.15  # excess over kinetic theory's viscosity
MACH = 0.08  # at 0.1 colloids settle 10 % faster than in proportion to gravity


def warnings(scene: Scene, engine: Engine) -> Iterator[str]:
    """What will be inaccurate, one line each: field, value and reason."""
    if scene.density < DENSITY:
        yield (
            f"density = {scene.density!r}: most fluid particles are alone in their cell, colliding "
            "with nobody; temperatures are 10 % and more too low"
        )
    if scene.hydrodynamics == "on":
        yield from _mean_free_path(scene)
        yield from _long_time_tail(scene)
        if isinstance(scene, Channel) and scene.expected_speed > MACH * SOUND:
            yield (
                f"gravity = {scene.gravity!r}: colloids would fall at about "
                f"{scene.expected_speed:.2g} a0/t0, no longer slow against sound ({SOUND:g}) and "
                "so not in proportion to gravity"
            )
    if isinstance(scene, Channel) and scene.wall_strength == 0:
        yield (
            "wall_strength = 0.0: only the fluid keeps colloids off the walls; one that crosses a "
            "wall is lost and stops the run"
        )
    if engine == "srd" and scene.thermostat == "none":
        yield (
            "thermostat = 'none': fix srd cuts speeds and so cools the fluid slowly, by 10 % in "
            "1000 collisions"
        )


def _mean_free_path(scene: Scene) -> Iterator[str]:
    """The longer of the flight in a collision time and the path on which momentum keeps its way.

    The latter is the kinetic part of the viscosity over the thermal speed; the viscosity being
    a tau + b / tau in all formulas, that is a tau = (2 nu(2 tau) - nu(tau)) / 3.
    """
    tau = scene.collision_time
    kinetic = (2 * _viscosity(scene, 2 * tau) - _viscosity(scene, tau)) / 3
    field, value, path = max(
        ("collision_time", tau, tau), ("angle", scene.angle, kinetic), key=lambda one: one[2]
    )
    if path > KNUDSEN * scene.width:
        yield (
            f"{field} = {value!r}: the mean free path of {path:.3g} a0 is not short against the "
            f"width {scene.width!r}; above {KNUDSEN:g} of it there is no hydrodynamic flow"
        )


def _long_time_tail(scene: Scene) -> Iterator[str]:
    """Mode coupling's excess in 2D, kBT ln(L / a0) / (16 pi rho nu): docs/reference.md."""
    if scene.dimensions == 3:
        return
    nu = _viscosity(scene, scene.collision_time)
    excess = math.log(max(scene.box)) / (16 * math.pi * scene.density * nu**2)
    if excess > TAIL:
        yield (
            f"collision_time = {scene.collision_time!r}, density = {scene.density!r}: a fluid of "
            f"so low a viscosity ({nu:.2g}) is more viscous than kinetic theory says, by about "
            f"{excess:.0%} (long-time tail of 2D)"
        )


def _viscosity(scene: Scene, collision_time: float) -> float:
    rotation = scene.rotation if isinstance(scene, Bulk) else "coordinate_axes"
    angle = min(scene.angle, 179.99)  # at 180 degrees in 2D momentum never turns
    return viscosity(scene.density, collision_time, angle, scene.dimensions, rotation)
