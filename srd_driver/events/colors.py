"""Colour reactions at walls and at central particles, by lot and by the average over all lots.

A particle of colour A that reaches the first surface (the lower wall, contact with a central
particle) becomes B with probability p; a B that reaches the second (the upper wall, the imaginary
sphere of radius R_cut, from outside) becomes A (carmer-2012, Figs. 1 and 3). Colours act on
nothing, so the probability q of being A, given the trajectory, obeys q -> (1 - p) q at the first
surface and q -> q + p (1 - q) at the second: the exact mean of the label over all lots.
"""

from typing import Any

import numpy as np

from srd_driver.events.compiling import compiled
from srd_driver.events.state import (
    POSITION,
    SPEED_BIN,
    SPEED_BINS,
    TIME,
    VELOCITY,
)


def scrambled(word: Any) -> Any:
    """The mixing function of SplitMix64 (G. Steele et al., OOPSLA 2014)."""
    word += np.uint64(0x9E3779B97F4A7C15)
    word = (word ^ (word >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    word = (word ^ (word >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return word ^ (word >> np.uint64(31))


scrambled = compiled(scrambled)


def lot_of(seed: Any, m: Any, i: Any, visit: Any) -> Any:
    """A number in [0, 1) for the visit of a particle, whatever was drawn for others before."""
    word = scrambled(scrambled(seed + np.uint64(m)) + np.uint64(i))
    return float(scrambled(word + np.uint64(visit)) >> np.uint64(11)) * 2.0**-53


lot_of = compiled(lot_of)


def react(c: Any, m: Any, i: Any, surface: Any, speed: Any) -> None:
    """Particle i reaches reaction surface 0 (A to B) or 1 (B to A) of reference m.

    One lot serves all probabilities: each set of labels has the right law by itself.
    """
    lot = lot_of(c.seed, m, i, c.visits[m, i])
    c.visits[m, i] += 1
    bin_ = min(int(speed / SPEED_BIN), SPEED_BINS - 1)
    c.hits[surface] += 1
    for k in range(c.probability.size):
        p = c.probability[k]
        if lot < p and c.label[m, i, k] == 1 - surface:
            c.label[m, i, k] = surface
            c.reactions[surface, 0, k] += 1
            c.speeds[0, k, bin_] += 1
        q = c.chance[m, i, k]
        reacting = p * (q if surface == 0 else 1.0 - q)
        c.chance[m, i, k] = q - reacting if surface == 0 else q + reacting
        c.reactions[surface, 1, k] += reacting
        c.speeds[1, k, bin_] += reacting


react = compiled(react)


def entering(s: Any, c: Any, i: Any, j: Any, now: Any) -> Any:
    """Normal speed with which j enters the sphere about i in the flight that ends now, or -1."""
    body = s.body
    start = max(body[i, TIME], body[j, TIME], c.settled[0])
    length = now - start
    result = -1.0
    for end in range(2):  # the nearest image at either end: another may take over in between
        at = start + end * length
        square = b = speed = 0.0
        for axis in range(3):
            u = body[j, VELOCITY + axis] - body[i, VELOCITY + axis]
            r = (
                body[j, POSITION + axis]
                + body[j, VELOCITY + axis] * (at - body[j, TIME])
                - body[i, POSITION + axis]
                - body[i, VELOCITY + axis] * (at - body[i, TIME])
            )
            r -= s.lengths[axis] * np.rint(r * s.inverse[axis])
            r -= end * u * length  # back to the start
            square += r * r
            b += r * u
            speed += u * u
        gap = square - c.cutoff * c.cutoff
        if gap > 0.0 and b < 0.0:
            root = b * b - speed * gap
            if root > 0.0 and gap <= (np.sqrt(root) - b) * length:
                result = np.sqrt(root) / c.cutoff
    return result


entering = compiled(entering)


def pass_surfaces(s: Any, c: Any, i: Any, now: Any) -> None:
    """Reactions at the imaginary spheres since the last change of particle i, before the next."""
    own = c.center_of[i]
    for m in range(c.center.size):
        if m != own:
            speed = entering(s, c, c.center[m], i, now)
            if speed >= 0.0:
                react(c, m, i, 1, speed)
    if own >= 0:
        for j in range(s.body.shape[0]):
            if j != i:
                speed = entering(s, c, i, j, now)
                if speed >= 0.0:
                    react(c, own, j, 1, speed)


pass_surfaces = compiled(pass_surfaces)


def settle(s: Any, c: Any) -> None:
    """Reactions at the imaginary spheres in the flights that are going on."""
    now = s.clock[0]
    for m in range(c.center.size):
        for j in range(s.body.shape[0]):
            if j != c.center[m]:
                speed = entering(s, c, c.center[m], j, now)
                if speed >= 0.0:
                    react(c, m, j, 1, speed)
    c.settled[0] = now


settle = compiled(settle)
