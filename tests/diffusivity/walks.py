"""Smoluchowski walks with known D and F, as MDAnalysis Universes."""

from typing import Any

import MDAnalysis
import numpy as np
from MDAnalysis.coordinates.memory import MemoryReader
from numpy.typing import NDArray

Array = NDArray[np.float64]

LENGTH = 4.0  # reflecting ends at 0 and LENGTH
FRAME = 0.02


def diffusivity(z: Array) -> Array:
    return 1.0 + 0.5 * np.cos(2 * np.pi * z / LENGTH)


def free_energy(z: Array) -> Array:
    return 0.5 * np.sin(2 * np.pi * z / LENGTH)


def walk(walkers: int, frames: int, seed: int, substeps: int = 5) -> Array:
    """z(t), (frames, walkers), in equilibrium: dz = (D' - D F') dt + sqrt(2 D dt) xi."""
    random = np.random.default_rng(seed)
    k = 2 * np.pi / LENGTH
    z = random.uniform(0, LENGTH, 20 * walkers)
    z = z[random.random(len(z)) < np.exp(-free_energy(z) - 0.5)][:walkers]
    assert len(z) == walkers
    step = FRAME / substeps
    path = np.empty((frames, walkers))
    for frame in range(frames):
        path[frame] = z
        for _ in range(substeps):
            s, c = np.sin(k * z), np.cos(k * z)
            d = 1.0 + 0.5 * c
            z = z + (-0.5 * k * s - d * 0.5 * k * c) * step
            z += np.sqrt(2 * d * step) * random.normal(size=walkers)
            z = np.abs(z)
            z = LENGTH - np.abs(LENGTH - z)
    return path


def universe(path: Array) -> Any:
    """The walkers of `path` as atoms that move along z."""
    frames, walkers = path.shape
    positions = np.full((frames, walkers, 3), 5.0, dtype=np.float32)
    positions[:, :, 2] = path
    made = MDAnalysis.Universe.empty(walkers, trajectory=True)
    made.load_new(positions, format=MemoryReader, dt=FRAME)
    return made
