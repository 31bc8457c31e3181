"""Colloids and their fluid in a slit, coarse-grained along it: two coupled conservation laws.

An MPC fluid is an ideal gas, and the walls take up its momentum: disturbances of its pressure do
not travel along a slit as sound, they diffuse, with D = kBT n_f K (2 a0^2/t0 for the thesis'
parameters; 100 a0 take 2500 t0). So the fluid that falling colloids drag along piles up ahead of
them, and its density is a slow field beside theirs:

    d_t rho + d_x (rho v) = 0,   rho v from   v = (V(rho) - X(rho) d_x p) / h
    d_t m + d_x (pi u + A (1 - pi) rho v) = 0,   u = (rho F X(rho) - K d_x p) / h

rho: colloids per area; m: mass per area over n_f m_f; A rho: area fraction of the colloids, whose
mass density is n_f m_f; pi = (m - A rho) / (1 - A rho): fluid density in the free area over n_f;
p = n_f kBT pi; u: volume flux per width; F = M_c g: force on a colloid. V and X are measured in
homogeneous channels, where d_x p = 0: speed of the colloids at rest, and volume flux per force per
area. That the same X tells how a pressure gradient pushes colloids is Onsager's reciprocity. K is
the flux per pressure gradient of the pure fluid, 1/12 L_y^2/eta without slip; colloids that follow
the flow are taken not to change it. h = eta(pi)/eta(1), by the collisional part of (3.16), scales
all friction with the fluid's density.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array

_STATES = 9  # between two cells, to look for the extremum of the flux


@dataclass(frozen=True)
class TwoFluid:
    """What the two conservation laws need to know (reduced units, a0 = kBT = m_f = 1).

    Attributes:
        speed: V(rho) [a0/t0], arrays in and out.
        coupling: X(rho) [a0^3/t0 per unit of force], arrays in and out.
        permeability: K, of the pure fluid at pi = 1 [a0^3/t0 per unit of force].
        force: on a colloid along x, F.
        area: of a colloid, A [a0^2].
        fluid_density: n_f [1/a0^2].
    """

    speed: Callable[[Array], Array]
    coupling: Callable[[Array], Array]
    permeability: float
    force: float
    area: float
    fluid_density: float

    def viscosity_ratio(self, fluid: Array) -> Array:
        """h = eta(pi)/eta(1), the factor n - 1 + exp(-n) of (3.16)."""
        n, n_f = self.fluid_density * fluid, self.fluid_density
        return np.asarray((n - 1 + np.exp(-n)) / (n_f - 1 + np.exp(-n_f)))

    def solve(self, density: ArrayLike, spacing: float, times: ArrayLike) -> tuple[Array, Array]:
        """Density of the colloids and of the fluid, periodic along x, from pi = 1 at t = 0.

        Finite volumes: Godunov's flux for the colloids, central ones for the pressure, explicit in
        time. Both contents are conserved to rounding.

        Args:
            density: rho at t = 0, averages over equal cells, (N,) [1/a0^2].
            spacing: edge of a cell [a0].
            times: increasing, (T,) [t0].

        Returns:
            rho [1/a0^2] and pi, both (T, N).
        """
        rho = np.array(density, dtype=float)
        mass = np.ones_like(rho)
        found_rho, found_fluid = [], []
        now = 0.0
        for time in np.asarray(times, dtype=float):
            while now < time:
                step = min(self._step(rho, mass, spacing), time - now)
                flux, mass_flux = self._fluxes(rho, mass, spacing)
                rho -= step / spacing * (flux - np.roll(flux, 1))
                mass -= step / spacing * (mass_flux - np.roll(mass_flux, 1))
                now += step
            found_rho.append(rho.copy())
            found_fluid.append(self._fluid(rho, mass))
        return np.array(found_rho), np.array(found_fluid)

    def _fluid(self, rho: Array, mass: Array) -> Array:
        return (mass - self.area * rho) / (1 - self.area * rho)

    def _step(self, rho: Array, mass: Array, spacing: float) -> float:
        """A stable time step: 0.4 of the limits of diffusion and of advection."""
        thinnest = float(self.viscosity_ratio(self._fluid(rho, mass)).min())
        free = 1 - self.area * float(rho.max())
        diffusion = self.fluid_density * self.permeability / (thinnest * free)
        fine = np.linspace(0, 1.2 * float(rho.max()), 61)
        fastest = float(np.abs(np.gradient(fine * self.speed(fine), fine)).max()) / thinnest
        return 0.4 / (2 * diffusion / spacing**2 + fastest / spacing)

    def _fluxes(self, rho: Array, mass: Array, spacing: float) -> tuple[Array, Array]:
        """Of colloids and of mass, at the right face of each cell, (N,) each."""
        fluid, right = self._fluid(rho, mass), np.roll(rho, -1)
        gradient = self.fluid_density * (np.roll(fluid, -1) - fluid) / spacing
        face = (fluid + np.roll(fluid, -1)) / 2
        h = self.viscosity_ratio(face)
        part = np.linspace(0, 1, _STATES)[:, None]
        between = rho + part * (right - rho)
        candidates = between * (self.speed(between) - self.coupling(between) * gradient) / h
        flux = np.where(rho <= right, candidates.min(axis=0), candidates.max(axis=0))
        middle = (rho + right) / 2
        pull = middle * self.force * self.coupling(middle)
        volume_flux = (pull - self.permeability * gradient) / h
        return flux, face * volume_flux + self.area * (1 - face) * flux
