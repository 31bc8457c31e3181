"""The state every engine starts from (tabatabaei-2009, 3.4.4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.bulk import Bulk
from lammps_inputs.channel import Channel
from lammps_inputs.poiseuille import Poiseuille

Array = NDArray[np.float64]

INITIAL_STREAM = 0  # Philox key of the initial state; the engines' own streams count from 1


@dataclass(frozen=True)
class InitialState:
    """Positions [a0] and velocities [a0/t0]: fluid (N_f, d), colloids (N_c, 2)."""

    fluid_positions: Array
    fluid_velocities: Array
    colloid_positions: Array
    colloid_velocities: Array


def initial_state(scene: Channel | Poiseuille | Bulk) -> InitialState:
    """Colloids on the mid-line, fluid uniform in the space they leave, Maxwell velocities.

    No fluid particle lies within r_c of a colloid centre. The total momentum is made zero by one
    velocity subtracted from every particle; the temperature is kBT = 1 on average. A function of
    the scene alone: the same scene and seed give the same state.
    """
    random = np.random.Generator(np.random.Philox(key=[scene.seed, INITIAL_STREAM]))
    if isinstance(scene, Channel):
        colloid_positions = scene.initial_colloid_positions
        colloid_velocities = random.normal(size=(scene.colloids, 2)) / np.sqrt(scene.colloid_mass)
        colloid_mass, radius = scene.colloid_mass, scene.colloid_radius
    else:
        colloid_positions = colloid_velocities = np.empty((0, scene.dimensions))
        colloid_mass = radius = 0.0

    fluid_positions = _positions_outside(
        colloid_positions, radius, np.array(scene.box), scene.fluid_particles, random
    )
    fluid_velocities = random.normal(size=fluid_positions.shape)
    momentum = fluid_velocities.sum(axis=0) + colloid_mass * colloid_velocities.sum(axis=0)
    drift = momentum / (len(fluid_velocities) + colloid_mass * len(colloid_velocities))
    fluid_velocities -= drift
    if isinstance(scene, Bulk):
        y = fluid_positions[:, 1]
        wave = scene.shear_wave * np.sin(2 * np.pi * y / scene.width)
        fluid_velocities[:, 0] += wave - wave.mean()
    return InitialState(
        fluid_positions, fluid_velocities, colloid_positions, colloid_velocities - drift
    )


def _positions_outside(
    centres: Array, radius: float, box: Array, count: int, random: np.random.Generator
) -> Array:
    """Uniform positions outside all discs, drawn until `count` are accepted."""
    accepted = np.empty((0, len(box)))
    while len(accepted) < count:
        trial = random.random((2 * (count - len(accepted)) + 16, len(box))) * box
        free = np.ones(len(trial), dtype=bool)
        for centre in centres:
            separation = trial - centre
            separation[:, 0] -= box[0] * np.round(separation[:, 0] / box[0])
            free &= np.einsum("ij,ij->i", separation, separation) > radius**2
        accepted = np.concatenate([accepted, trial[free]])
    return accepted[:count]
