"""Kinematic viscosity of the MPC fluid by kinetic theory.

All formulas assume molecular chaos and Poisson occupation of the cells, and are a sum of a kinetic
part, from particles that fly, and a collisional part, from momentum that a collision moves within
its cell. Units a0 = kBT = m_f = 1, viscosity in a0^2/t0.
"""

import math
from typing import NamedTuple

from lammps_inputs.system import Rotation, Solvent


class Viscosity(NamedTuple):
    """The two parts of a kinematic viscosity [a0^2/t0]."""

    kinetic: float
    collisional: float

    @property
    def total(self) -> float:
        """Their sum."""
        return self.kinetic + self.collisional


def viscosity(
    density: float,
    collision_time: float,
    angle: float,
    dimensions: int = 2,
    rotation: Rotation = "coordinate_axes",
) -> float:
    """Kinematic viscosity nu of an MPC fluid, the sum of `viscosity_parts` [a0^2/t0]."""
    return viscosity_parts(density, collision_time, angle, dimensions, rotation).total


def viscosity_parts(
    density: float,
    collision_time: float,
    angle: float,
    dimensions: int = 2,
    rotation: Rotation = "coordinate_axes",
) -> Viscosity:
    """Kinetic and collisional part of the kinematic viscosity of an MPC fluid.

    Args:
        density: n_f, particles per cell.
        collision_time: tau_c [t0].
        angle: alpha [degrees].
        dimensions: 2 or 3.
        rotation: axis of the 3D rotation; about the coordinate axes it is by 90 degrees.
    """
    alpha = math.radians(angle)
    if dimensions == 2:
        return viscosity_2d(density, collision_time, alpha)
    if rotation == "random_axis":
        return viscosity_random_axis(density, collision_time, alpha)
    return viscosity_coordinate_axes(density, collision_time)


def solvent_viscosity(solvent: Solvent, dimensions: int) -> Viscosity:
    """The parts for a solvent, as if its hydrodynamics were on."""
    speed = math.sqrt(solvent.temperature)
    tau = solvent.collision_time * speed / solvent.cell  # where the cell and kBT are 1
    parts = viscosity_parts(solvent.density, tau, solvent.angle, dimensions, solvent.rotation)
    return Viscosity(*(part * solvent.cell * speed for part in parts))


def viscosity_theory(solvent: Solvent, dimensions: int) -> float | None:
    """The sum where theory has one: not for a random solvent, nor in 2D for 180 degrees.

    Units a0^2/t0.
    """
    total = solvent_viscosity(solvent, dimensions).total
    return total if solvent.hydrodynamics == "on" and math.isfinite(total) else None


def viscosity_2d(density: float, collision_time: float, alpha: float) -> Viscosity:
    """2D, rotation by +-alpha [rad] (tabatabaei-2009 3.16).

    At 180 degrees the kinetic part is infinite: a collision reverses the transverse momentum of
    particles, which then never decays on average.
    """
    p = _colliding(density)
    decay = p * (1 - math.cos(2 * alpha))
    endless = alpha >= math.pi or decay <= 0
    kinetic = math.inf if endless else collision_time * (1 / decay - 0.5)
    return Viscosity(kinetic, p * (1 - math.cos(alpha)) / (12 * collision_time))


def viscosity_coordinate_axes(density: float, collision_time: float) -> Viscosity:
    """3D, +-90 degrees about the coordinate axes (hecht-2005 28, Poisson-corrected).

    The printed kinetic factor (M + 2) / (4 (M - 1)) holds for exactly M particles in a cell; with
    Poisson occupation it is (1 + 2 q) / (4 (1 - q)), q = (1 - e^-M) / M.
    """
    p = _colliding(density)
    q = 1 - p
    return Viscosity(collision_time * (1 + 2 * q) / (4 * p), p / (18 * collision_time))


def viscosity_random_axis(density: float, collision_time: float, alpha: float) -> Viscosity:
    """3D, by alpha [rad] about an axis uniform on the sphere (3.8).

    Gompper, Ihle, Kroll and Winkler, Adv. Polym. Sci. 221, 1 (2009), table 1.
    """
    p = _colliding(density)
    decay = p * (2 - math.cos(alpha) - math.cos(2 * alpha))
    kinetic = 5 / decay - 1 if decay > 0 else math.inf
    return Viscosity(
        collision_time / 2 * kinetic, p * (1 - math.cos(alpha)) / (18 * collision_time)
    )


def self_diffusion_2d(density: float, collision_time: float, angle: float) -> float:
    """Of the fluid's own particles in 2D, if their velocities decorrelate as theory has it.

    kBT tau_c (1 / (p (1 - cos alpha)) - 1 / 2), p the colliding part of the particles (Ihle and
    Kroll, Phys. Rev. E 67, 066706, 2003); [a0^2/t0].
    """
    decay = _colliding(density) * (1 - math.cos(math.radians(angle)))
    return collision_time * (1 / decay - 0.5)


def mobility_in_cells(solvent: Solvent, mass: float, dimensions: int) -> float:
    """Drift over force of a lone particle that takes part in collisions with a bath [t0/m_f].

    The bath has no memory (hydrodynamics = bath), so that a collision leaves the particle the share
    <(M + n g) / (M + n)> of its velocity, n fluid particles by Poisson in the cell, g = cos alpha
    in 2D and (1 + 2 cos alpha) / 3 in 3D: a geometric series, whose mean over an interval it is.
    """
    cosine = math.cos(math.radians(solvent.angle))
    kept = cosine if dimensions == 2 else (1 + 2 * cosine) / 3
    mean = solvent.density
    most = int(mean + 20 * math.sqrt(mean) + 20)
    poisson = (math.exp(n * math.log(mean) - mean - math.lgamma(n + 1)) for n in range(most))
    share = math.fsum(p * (mass + n * kept) / (mass + n) for n, p in enumerate(poisson))
    return solvent.collision_time / mass * (1 / (1 - share) - 0.5)


def rotational_mobility(solvent: Solvent, radius: float) -> float:
    """Angular velocity over torque of a lone sphere that reflects the fluid [t0/m_f a0^2].

    With kBT = 1 its D_r too. Fluid at rest that leaves with the velocity of the surface takes the
    torque xi_E omega, xi_E = (4/3) sqrt(2 pi) n R^4: all there is without hydrodynamics. With them
    the fluid follows, as Debye has it, and slips (J. C. Maxwell, Phil. Trans. 170, 231, 1879): the
    fluid that flows in brings half of the kinetic stress, so that the rest is xi_E times the slip.
    The mobility is 1 / (8 pi eta R^3) + (1 - eta_kin / (2 eta)) / xi_E, to first order in mean free
    path and cell over R.
    """
    speed = math.sqrt(2 * math.pi * solvent.temperature)
    free_molecular = 4 / 3 * speed * solvent.density * radius**4
    if solvent.hydrodynamics != "on":
        return 1 / free_molecular
    nu = solvent_viscosity(solvent, dimensions=3)
    debye = 8 * math.pi * solvent.density * nu.total * radius**3
    return 1 / debye + (1 - nu.kinetic / nu.total / 2) / free_molecular


def _colliding(density: float) -> float:
    """(M - 1 + e^-M) / M, the mean of 1 - 1/n over the particles of Poisson cells."""
    if density < 1e-4:  # where the difference has no digits left
        return density / 2 - density**2 / 6
    return 1 + math.expm1(-density) / density
