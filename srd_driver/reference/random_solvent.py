"""Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3)."""

import numpy as np
from numpy.typing import NDArray

from srd_driver.reference.counter_random import CounterRandom, Stream, Words

Array = NDArray[np.float64]

ROUNDS = 8


def shuffle(velocities: Array, random: CounterRandom) -> None:
    """Interchange the velocities of all particles, in place: i gets the velocity of pi(i).

    Total momentum and energy stay; local momentum does not.
    """
    velocities[:] = velocities[:, permutation(velocities.shape[1], random)]


def permutation(count: int, random: CounterRandom) -> NDArray[np.intp]:
    """A keyed permutation pi of 0 ... count - 1, each value computed on its own.

    A Feistel network of eight rounds on 2 h bits, h the smallest with 2^(2 h) >= count: of the
    number split into left (upper h bits) and right, round k makes (right, left xor f_k(right)).
    Values from count on are sent through the network again until they fall below it. The key of
    round k is word k of stream SHUFFLE: items 0 and 1, four words each.
    """
    half = np.uint64(max(1, ((count - 1).bit_length() + 1) // 2))
    keys = random.words(Stream.SHUFFLE, ROUNDS // 4).T.ravel()
    image = _feistel(np.arange(count, dtype=np.uint64), half, keys)
    beyond = np.flatnonzero(image >= count)
    while beyond.size:
        image[beyond] = _feistel(image[beyond], half, keys)
        beyond = beyond[image[beyond] >= count]
    return image.astype(np.intp)


def _feistel(numbers: Words, half: np.uint64, keys: Words) -> Words:
    mask = (np.uint64(1) << half) - np.uint64(1)
    left, right = numbers >> half, numbers & mask
    for key in keys:
        left, right = right, left ^ (_mix(right + key) & mask)
    return (left << half) | right


def _mix(z: Words) -> Words:
    """The finaliser of SplitMix64, modulo 2^64."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


def bath(velocities: Array, random: CounterRandom) -> None:
    """Draw all velocities anew from the Maxwell distribution at kBT = m_f = 1, in place.

    Each component has the standard deviation sqrt(kBT / m_f), which the paper calls the variance.
    Particle i takes the first d normals of its block of stream BATH.
    """
    dimensions, particles = velocities.shape
    velocities[:] = random.normal(Stream.BATH, particles)[:dimensions]
