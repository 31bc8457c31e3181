"""The state every engine starts from (tabatabaei-2009, 3.4.4)."""

import math
from dataclasses import dataclass, field

import numpy as np

from lammps_inputs.system import Array, Box, Continuation, System

INITIAL_STREAM = 0  # Philox key of the initial state; the engines' own streams count from 1


@dataclass(frozen=True)
class InitialState:
    """Positions [a0] and velocities [a0/t0].

    Fluid (N_f, d); colloids, which are the particles of all species in their order, (N_c, d); the
    angular velocities, zero of those that do not rotate, (N_c, 3) [1/t0]. `tilt` is how far along x
    the image above a sheared box is ahead [a0].
    """

    fluid_positions: Array
    fluid_velocities: Array
    colloid_positions: Array
    colloid_velocities: Array
    colloid_spins: Array = field(default_factory=lambda: np.empty((0, 3)))
    tilt: float = 0.0


def initial_state(system: System, seed: int) -> InitialState:
    """Particles at their places, fluid uniform in the space they leave, Maxwell velocities.

    No fluid particle lies within the radius of a particle's centre, but where species are particles
    of their cell. The total momentum is made zero by one velocity subtracted from all, or from
    fluid and species by themselves where these rest first; the temperature is kBT = 1 on average,
    of the fluid that of the solvent. A shear wave of the solvent is added last, its mean taken off.
    A function of system and seed alone.
    """
    random = np.random.Generator(np.random.Philox(key=[seed, INITIAL_STREAM]))
    dimensions = system.box.dimensions
    masses = system.masses[:, np.newaxis]
    colloid_positions = np.empty((0, dimensions))
    if system.placement:
        colloid_positions = system.placement.positions(system.box, system.species, seed)
    colloid_velocities = random.normal(size=(system.particles, dimensions)) / np.sqrt(masses)
    tilt = 0.0
    if isinstance(system.placement, Continuation):
        colloid_velocities = system.placement.velocities(system.box, system.species)
        tilt = system.placement.tilt(system.box, system.species)

    fluid = system.solvent
    room = np.zeros_like(system.radii) if fluid and fluid.coupling == "cell" else system.radii
    fluid_positions = _positions_outside(
        colloid_positions, room, system.box, fluid.particles if fluid else 0, random
    )
    fluid_velocities = random.normal(size=fluid_positions.shape)
    if fluid:
        fluid_velocities *= math.sqrt(fluid.temperature)
    momentum, mass = fluid_velocities.sum(axis=0), len(fluid_velocities)
    of_species, heavy = _momentum(system, colloid_velocities)
    if system.rest:
        drift, fluid_drift = of_species / heavy, momentum / max(1, mass)
    else:
        drift = fluid_drift = (momentum + of_species) / (mass + heavy)
    fluid_velocities -= fluid_drift
    if fluid and fluid.shear_wave:
        y = fluid_positions[:, 1]
        wave = fluid.shear_wave * np.sin(2 * np.pi * y / system.box.sizes[1])
        fluid_velocities[:, 0] += wave - wave.mean()
    return InitialState(
        fluid_positions,
        fluid_velocities,
        colloid_positions,
        colloid_velocities - drift,
        _spins(system, random),
        tilt,
    )


def _momentum(system: System, velocities: Array) -> tuple[Array, float]:
    """Of all species, (d,) [m_f a0/t0], and their mass [m_f]."""
    momentum, mass, first = np.zeros(system.box.dimensions), 0.0, 0
    for species in system.species:
        own = velocities[first : first + species.count]
        momentum = momentum + species.mass * own.sum(axis=0)
        mass += species.mass * species.count
        first += species.count
    return momentum, mass


def _spins(system: System, random: np.random.Generator) -> Array:
    """Angular velocities of kBT = 1, (N_c, 3)."""
    inertia = system.inertias[:, np.newaxis]
    spins = np.zeros((system.particles, 3))
    if system.rotates:
        normal = random.normal(size=spins.shape)
        np.divide(normal, np.sqrt(inertia), out=spins, where=inertia > 0)
    return spins


def _positions_outside(
    centres: Array, radii: Array, box: Box, count: int, random: np.random.Generator
) -> Array:
    """Uniform positions outside all spheres, drawn until `count` are accepted."""
    sizes = np.array(box.sizes)
    accepted = np.empty((0, len(sizes)))
    while len(accepted) < count:
        trial = random.random((2 * (count - len(accepted)) + 16, len(sizes))) * sizes
        free = np.ones(len(trial), dtype=bool)
        for centre, radius in zip(centres[radii > 0], radii[radii > 0], strict=True):
            separation = box.nearest_image(trial - centre)
            free &= np.einsum("ij,ij->i", separation, separation) > radius**2
        accepted = np.concatenate([accepted, trial[free]])
    return accepted[:count]
