"""Colloids in the collision: particles of their cells, with their mass (hecht-2005, V and VIII B).

Arrays hold the components first, (d, N): the fluid, of mass 1, then the colloids. A `Cells` of all
of them is sorted together."""

import numpy as np

from lammps_inputs.system import Array
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream
from srd_driver.reference.thermostats import MONTE_CARLO_STRENGTH, acceptance


def mean_velocity(
    velocities: Array,
    masses: Array,
    cells: Cells,
    virtual_mass: Array | float = 0.0,
    virtual_momentum: Array | float = 0.0,
) -> Array:
    """u = sum m v / sum m of each cell (15), 0 where empty: (d, cells).

    Args:
        velocities: (d, N) [a0/t0].
        masses: (N,) [m_f].
        cells: the sorted particles.
        virtual_mass, virtual_momentum: of the virtual particles (cells,), (d, cells).
    """
    mass = cells.sum(masses) + virtual_mass
    momentum = cells.sum(masses * velocities) + virtual_momentum
    mean: Array = momentum / np.where(mass > 0, mass, 1.0)
    return mean


def monte_carlo(
    velocities: Array, masses: Array, cells: Cells, temperature: float, random: CounterRandom
) -> None:
    """Scale the relative velocities of each cell by a Monte Carlo trial (33), in place.

    zeta is 1 + epsilon or 1 / (1 + epsilon), accepted with the probability
    zeta^(d (n - 1)) exp(-(zeta^2 - 1) E / kBT*), E = sum m (v - u)^2 / 2 over the n particles of
    the cell. That is the printed (33), whose T is E / ((n - 1) k_B): 1.5 times the temperature of
    equipartition. The random numbers are those of `thermostats.monte_carlo`.
    """
    centre = cells.of_particles(mean_velocity(velocities, masses, cells))
    relative = velocities - centre
    u = random.uniform(Stream.THERMOSTAT, cells.count)
    scale = 1 + MONTE_CARLO_STRENGTH * u[0]
    scale = np.where(u[1] < 0.5, scale, 1 / scale)
    energy = cells.sum(masses * (relative**2).sum(axis=0)) / 2 / temperature
    freedom = len(velocities) * (cells.occupation - 1)
    accepted = (u[2] < acceptance(scale, energy, freedom)) & (cells.occupation > 1)
    velocities[:] = centre + relative * cells.of_particles(np.where(accepted, scale, 1.0))
