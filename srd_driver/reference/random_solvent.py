"""Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3)."""

import math

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.counter_random import CounterRandom, Stream, Words, box_muller, uniform


def shuffle(velocities: Array, random: CounterRandom) -> None:
    """Interchange the velocities of all particles, in place: i gets the velocity of pi(i).

    Total momentum and energy stay; local momentum does not.
    """
    velocities[:] = velocities[:, permutation(velocities.shape[1], random)]


def permutation(count: int, random: CounterRandom) -> NDArray[np.intp]:
    """A random permutation pi of 0 ... count - 1, each value computed on its own.

    i -> (a i + b) mod p, p the smallest prime that is not below `count`; an image from `count` on
    is sent through again. a = 1 + floor(u_0 (p - 1)) and b = floor(u_1 p) are of item 0 of stream
    SHUFFLE. Modulo p any two numbers have any two others as images with equal probability, as in a
    permutation drawn from all: momentum that neighbours share is scattered. What goes through again
    changes that of two numbers by 2 (p - count) / p at most: 8e-4 of 50 000, for which p = 50 021.
    """
    prime = _prime_from(count)
    u = random.uniform(Stream.SHUFFLE, 1)[:2, 0]
    factor, term = (np.uint64(x) for x in (1 + int(u[0] * (prime - 1)), int(u[1] * prime)))

    def once(numbers: Words) -> Words:
        images: Words = (factor * numbers + term) % np.uint64(prime)
        return images

    image = once(np.arange(count, dtype=np.uint64))
    beyond = np.flatnonzero(image >= count)
    while beyond.size:
        image[beyond] = once(image[beyond])
        beyond = beyond[image[beyond] >= count]
    return image.astype(np.intp)


def _prime_from(number: int) -> int:
    """The smallest prime that is not below a number."""
    prime = max(number, 2)
    while any(prime % divisor == 0 for divisor in range(2, math.isqrt(prime) + 1)):
        prime += 1
    return prime


def bath(velocities: Array, random: CounterRandom) -> None:
    """Draw all velocities anew from the Maxwell distribution at kBT = m_f = 1, in place.

    Each component has the standard deviation sqrt(kBT / m_f), which the paper calls the variance.
    Particle i takes the first d normals, by Box-Muller, of its four mixed words of stream BATH.
    """
    dimensions, particles = velocities.shape
    words = random.mixed(Stream.BATH, particles)
    velocities[:] = box_muller(uniform(words))[:dimensions]
