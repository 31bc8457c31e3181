"""Counter-based random numbers: Philox4x64-10, the generator of `numpy.random.Philox`.

A random number is a function of (seed, stream, collision step, item), item being a cell or a
particle. It does not depend on how many numbers were drawn before, so an engine that works through
cells or particles in another order, or in parallel, draws the same ones.

The contract, exactly: item `index` owns the block Philox4x64-10(key, counter) of four 64-bit words
with key = (seed, stream) and counter = (index + 1, step, block, 0), lowest word first. The + 1 is
numpy's, which increments its counter before it generates. `step` is the number of collisions done
before (0 in the first); `block` is 0 unless an item needs more than four words.
"""

import enum
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array

Words = NDArray[np.uint64]


class Stream(enum.IntEnum):
    """Second key of the generator. The initial state has 0, see `lammps_inputs.initial_state`."""

    SHIFT = 1  # item 0: one uniform per axis
    ROTATION = 2  # mixed words of cells: what turns their velocities
    WALL = 3  # item = cell: normals of the virtual particles
    THERMOSTAT = 4  # item = cell (Monte Carlo, Maxwell-Boltzmann) or particle (Andersen)
    SHUFFLE = 5  # items 0, 1: keys of the eight rounds of the permutation
    BATH = 6  # mixed words of particles: normals of their new velocities
    REFLECTION = 8  # item = particle, block = contact: its velocity after a contact with a colloid
    PAIR = 9  # step of molecular dynamics, item and block the lower and the higher atom number


@dataclass(frozen=True)
class CounterRandom:
    """The random numbers of one collision.

    Attributes:
        seed: first key.
        step: collisions done before this one.
    """

    seed: int
    step: int

    def words(self, stream: Stream, items: int, block: int = 0) -> Words:
        """The blocks of items 0 ... items - 1, shape (4, items)."""
        philox = np.random.Philox(key=[self.seed, stream], counter=[0, self.step, block, 0])
        words: Words = philox.random_raw(4 * items)
        return words.reshape(items, 4).T

    def block(self, stream: Stream, item: int, block: int = 0) -> Words:
        """That of one item, shape (4,)."""
        counter = [item, self.step, block, 0]  # counted on before it is used
        words: Words = np.random.Philox(key=[self.seed, stream], counter=counter).random_raw(4)
        return words

    def mixed(self, stream: Stream, items: int) -> Words:
        """Words of items 0 ... items - 1 of a stream of which every item needs some, (4, items).

        Word k of item i is number i of SplitMix64 from the seed key_k. The keys are the block of
        item 0: seeds of their own for each collision. A block of Philox for each cell or particle
        would take longer than all else that is done to it.
        """
        return split_mix(self.words(stream, 1), np.arange(items, dtype=np.uint64))

    def uniform(self, stream: Stream, items: int, block: int = 0) -> Array:
        """Four uniforms in [0, 1) for each item, shape (4, items): (word >> 11) 2^-53."""
        return uniform(self.words(stream, items, block))

    def normal(self, stream: Stream, items: int, block: int = 0) -> Array:
        """Four standard normals for each item, shape (4, items), by `box_muller`."""
        return box_muller(self.uniform(stream, items, block))


def split_mix(seeds: Words, numbers: Words) -> Words:
    """Numbers 0, 1, ... of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), modulo 2^64."""
    z = seeds + (numbers + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    words: Words = z ^ (z >> np.uint64(31))
    return words


def uniform(words: Words) -> Array:
    """Uniforms in [0, 1) from the upper 53 bits of each word."""
    uniforms: Array = (words >> np.uint64(11)).astype(float) * 2.0**-53
    return uniforms


def box_muller(u: Array) -> Array:
    """Standard normals from uniforms in [0, 1), both (4, n).

    Rows 0 and 1 give r cos(2 pi u1) and r sin(2 pi u1), r = sqrt(-2 ln(1 - u0)); so do 2 and 3.
    """
    radius = np.sqrt(-2 * np.log1p(-u[0::2]))
    angle = 2 * np.pi * u[1::2]
    normals = np.empty_like(u)
    normals[0::2] = radius * np.cos(angle)
    normals[1::2] = radius * np.sin(angle)
    return normals
