"""Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3)."""

import math

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.counter_random import CounterRandom, Stream, Words, box_muller, uniform

ROUNDS = 8


def shuffle(velocities: Array, random: CounterRandom) -> None:
    """Interchange the velocities of all particles, in place: i gets the velocity of pi(i).

    Total momentum and energy stay; local momentum does not.
    """
    velocities[:] = velocities[:, permutation(velocities.shape[1], random)]


def permutation(count: int, random: CounterRandom) -> NDArray[np.intp]:
    """A keyed permutation pi of 0 ... count - 1, each value computed on its own.

    A Feistel network of eight rounds on a table of `count` places or a few more: it has c columns,
    c the smallest with c^2 >= count, and r = ceil(count / c) rows. Even rounds move the row around
    by floor(f r / 2^32), f the upper 32 bits of mix(column + key_k); odd rounds move the column in
    the same way by what the row says. A value from count on is sent through the network again. The
    key of round k is word k of stream SHUFFLE: items 0 and 1, four words each.
    """
    columns = math.isqrt(count - 1) + 1
    sizes = np.array([-(-count // columns), columns], dtype=np.uint64)
    keys = random.words(Stream.SHUFFLE, ROUNDS // 4).T.ravel()
    image = _feistel(np.arange(count, dtype=np.uint64), sizes, keys)
    beyond = np.flatnonzero(image >= count)
    while beyond.size:
        image[beyond] = _feistel(image[beyond], sizes, keys)
        beyond = beyond[image[beyond] >= count]
    return image.astype(np.intp)


def _feistel(numbers: Words, sizes: Words, keys: Words) -> Words:
    place = list(np.divmod(numbers, sizes[1]))
    for k, key in enumerate(keys):
        half = k % 2
        distance = (_mix(place[1 - half] + key) >> np.uint64(32)) * sizes[half] >> np.uint64(32)
        place[half] = (place[half] + distance) % sizes[half]
    image: Words = place[0] * sizes[1] + place[1]
    return image


def _mix(z: Words) -> Words:
    """The finaliser of SplitMix64, modulo 2^64."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


def bath(velocities: Array, random: CounterRandom) -> None:
    """Draw all velocities anew from the Maxwell distribution at kBT = m_f = 1, in place.

    Each component has the standard deviation sqrt(kBT / m_f), which the paper calls the variance.
    Particle i takes the first d normals, by Box-Muller, of four words: word k is number i + 1 of
    SplitMix64 from the seed key_k, mix(key_k + (i + 1) 9E3779B97F4A7C15). The keys are the words of
    item 0 of stream BATH: seeds of their own for each collision. A block of Philox for each
    particle would take longer than all else that the particle does.
    """
    dimensions, particles = velocities.shape
    steps = np.arange(1, particles + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    words = _mix(random.words(Stream.BATH, 1) + steps)
    velocities[:] = box_muller(uniform(words))[:dimensions]
