"""Rotation of spheres: spins, and orientations as quaternions (hecht-2005, 9 and 10).

Spins are (3, N) in three dimensions and (1, N), about z, in two. (9) lacks the moment of inertia:
omega changes by T / I.
"""

import numpy as np

from lammps_inputs.system import Array

SPHERE = 0.4  # moment of inertia of a homogeneous sphere over m R^2


def cross(spins: Array, arms: Array) -> Array:
    """omega x r, (d, N)."""
    if len(arms) == 2:
        return np.stack([-spins[0] * arms[1], spins[0] * arms[0]])
    product: Array = np.cross(spins, arms, axis=0)
    return product


def torque(arms: Array, forces: Array) -> Array:
    """r x F, (3, N), or its z component (1, N) in two dimensions."""
    if len(arms) == 2:
        return np.stack([arms[0] * forces[1] - arms[1] * forces[0]])
    product: Array = np.cross(arms, forces, axis=0)
    return product


def kick(spins: Array, torques: Array, inertia: Array | float, time: float) -> None:
    """omega + dt T / I, in place (9 corrected); half a step before and after, as `nve/sphere`."""
    spins += time * torques / inertia


def turn(orientations: Array, spins: Array, time: float) -> Array:
    """Orientations after a time at these spins (10): unit quaternions, scalar first (4, N).

    The rotation by |omega| dt about omega, applied from the left: exact for a constant spin.
    """
    speed = np.sqrt((spins**2).sum(axis=0))
    half = 0.5 * speed * time
    w, axis = np.cos(half), spins * (0.5 * time * np.sinc(half / np.pi))
    scalar, vector = orientations[0], orientations[1:]
    return np.vstack(
        [
            w * scalar - (axis * vector).sum(axis=0),
            w * vector + scalar * axis + np.cross(axis, vector, axis=0),
        ]
    )
