"""Where a scene runs but is inaccurate: the warnings, from the map of docs/stability.md.

What cannot run at all is refused by the scene itself (`problems`).
"""

from collections.abc import Iterator

from lammps_inputs import Channel, Scene
from lammps_inputs.bulk import Bulk
from lammps_inputs.channel import SOUND
from lammps_inputs.deck import Engine
from lammps_inputs.viscosity import viscosity

DENSITY = 2.0  # below, cells often hold one particle, which collides with nobody
KNUDSEN = 0.05  # mean free path over width, above which the fluid is no continuum
COLLISION_TIME = 0.005  # below, the same particles collide again and again
MACH = 0.1  # settling is linear in gravity below


def warnings(scene: Scene, engine: Engine) -> Iterator[str]:
    """What will be inaccurate, one line each: field, value and reason."""
    if scene.density < DENSITY:
        yield (
            f"density = {scene.density!r}: fluid particles are often alone in their cell; below "
            f"{DENSITY:g} the viscosity is off theory by 20 % and more"
        )
    if scene.hydrodynamics == "on":
        yield from _mean_free_path(scene)
        if scene.collision_time < COLLISION_TIME:
            yield (
                f"collision_time = {scene.collision_time!r}: particles collide with the same "
                f"neighbours again and again; below {COLLISION_TIME:g} the viscosity falls 10 to "
                "20 % short of theory"
            )
        if isinstance(scene, Channel) and scene.expected_speed > MACH * SOUND:
            yield (
                f"gravity = {scene.gravity!r}: colloids would fall at about "
                f"{scene.expected_speed:.2g} a0/t0, no longer slow against sound ({SOUND:g}) and "
                "so not in proportion to gravity"
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


def _viscosity(scene: Scene, collision_time: float) -> float:
    rotation = scene.rotation if isinstance(scene, Bulk) else "coordinate_axes"
    angle = min(scene.angle, 179.99)  # at 180 degrees in 2D momentum never turns
    return viscosity(scene.density, collision_time, angle, scene.dimensions, rotation)
