"""Thermostats of the fluid, each applied once after the rotation; kBT = m_f = 1.

Equations of tabatabaei-2009, 3.3.8 and 3.4.6. Arrays hold the components first, (d, N).
"""

import numpy as np

from lammps_inputs.system import Array
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream, box_muller, uniform

MONTE_CARLO_STRENGTH = 0.1  # gamma, the largest epsilon of (3.55); half the trials are accepted
ANDERSEN_FREQUENCY = 0.1  # nu, redrawings of a particle's velocity in a time unit [1/t0]


def layer(velocities: Array, cells: Cells) -> None:
    """Rescale relative velocities so that each layer of cells has kBT = 1 (3.53, 3.54).

    A layer is a row of the shifted grid parallel to the walls. With d degrees of freedom to a
    particle, sum_j sum_i (v_i - v_cm,j)^2 / 2 = (d / 2) (particles - occupied cells) kBT'. A layer
    without relative motion stays as it is.
    """
    dimensions, layers = len(velocities), cells.shape[1]
    centre = cells.of_particles(cells.mean_velocity(velocities))
    relative = velocities - centre
    energy = np.bincount(cells.rows, cells.sum((relative**2).sum(axis=0)), layers) / 2
    free = np.bincount(cells.rows, np.maximum(cells.occupation - 1, 0), layers)
    temperature = energy / (0.5 * dimensions * np.maximum(free, 1))
    scale = np.sqrt(1 / np.where(energy > 0, temperature, 1.0))
    velocities[:] = centre + relative * cells.of_particles(scale[cells.rows])


def monte_carlo(velocities: Array, cells: Cells, random: CounterRandom) -> None:
    """Scale the relative velocities of each cell by a Monte Carlo trial (3.55 to 3.57).

    epsilon is uniform in [0, gamma) from the cell's first uniform; the factor zeta is 1 + epsilon
    where the second is below 1/2, else 1 / (1 + epsilon); it is accepted where the third is below
    `acceptance`.
    """
    centre = cells.of_particles(cells.mean_velocity(velocities))
    relative = velocities - centre
    u = random.uniform(Stream.THERMOSTAT, cells.count)
    scale = 1 + MONTE_CARLO_STRENGTH * u[0]
    scale = np.where(u[1] < 0.5, scale, 1 / scale)
    energy = cells.sum((relative**2).sum(axis=0)) / 2
    freedom = len(velocities) * (cells.occupation - 1)
    accepted = (u[2] < acceptance(scale, energy, freedom)) & (cells.occupation > 1)
    velocities[:] = centre + relative * cells.of_particles(np.where(accepted, scale, 1.0))


def acceptance(scale: Array, energy: Array, freedom: Array) -> Array:
    """zeta^f exp(-(zeta^2 - 1) E / kBT), f = d (n - 1) (3.56 corrected for the dimension).

    E is the kinetic energy of the relative motion: (n - 1) T of (3.56) with the T of (3.57).
    """
    return np.exp(freedom * np.log(scale) - (scale**2 - 1) * energy)


def maxwell_boltzmann(velocities: Array, cells: Cells, random: CounterRandom) -> None:
    """Scale the relative velocities of each cell to an energy from its canonical distribution.

    Maxwell-Boltzmann scaling: C.-C. Huang et al., J. Comput. Phys. 229, 168 (2010). The relative
    kinetic energy of f = d (n - 1) degrees of freedom has a density E^(f/2 - 1) exp(-E / kBT): a
    sum of floor(f / 2) exponentials -ln(1 - u) and, for odd f, half a normal squared. The uniforms
    are the cell's first in blocks 0, 1, ...; the normal is the first of the next block.
    """
    centre = cells.of_particles(cells.mean_velocity(velocities))
    relative = velocities - centre
    energy = cells.sum((relative**2).sum(axis=0)) / 2
    freedom = len(velocities) * np.maximum(cells.occupation.astype(np.intp) - 1, 0)
    blocks = -(-(freedom // 2) // 4)
    drawn = np.zeros(cells.count)
    for block in range(int(blocks.max()) + 1):
        u = random.uniform(Stream.THERMOSTAT, cells.count, block)
        used = 4 * block + np.arange(4)[:, None] < freedom // 2
        drawn -= np.log1p(-u, where=used, out=np.zeros_like(u)).sum(axis=0)
        odd = (freedom % 2 == 1) & (blocks == block)
        drawn += np.where(odd, 0.5 * box_muller(u)[0] ** 2, 0.0)
    scaled = (freedom > 0) & (energy > 0)
    scale = np.sqrt(np.where(scaled, drawn, 1.0) / np.where(scaled, energy, 1.0))
    velocities[:] = centre + relative * cells.of_particles(scale)


def rescale(velocities: Array) -> None:
    """Rescale all velocities to a kinetic energy of d N / 2 (3.39, 3.40)."""
    energy = 0.5 * np.sum(velocities**2)
    if energy > 0:
        velocities *= np.sqrt(0.5 * velocities.size / energy)


def andersen(velocities: Array, time: float, random: CounterRandom) -> None:
    """Redraw each velocity from the Maxwell distribution with probability nu time (3.3.8).

    A particle is chosen where the first uniform of its block 0 is below nu time; the components of
    its velocity are the first d normals of its block 1.
    """
    dimensions, particles = velocities.shape
    u = random.uniform(Stream.THERMOSTAT, particles)[0]
    chosen = np.flatnonzero(u < ANDERSEN_FREQUENCY * time)
    words = random.words(Stream.THERMOSTAT, particles, block=1)[:, chosen]
    velocities[:, chosen] = box_muller(uniform(words))[:dimensions]
