"""Close packings with vacancies: where dense hard spheres start, before they melt."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lammps_inputs.system import Array, Box, Species

_TOUCHING = 1 + 1e-9
_CURVE_BITS = 20  # of each coordinate; 3 of them fill a word


@dataclass(frozen=True)
class ClosePacking:
    """Spheres of one kind on the sites of a stretched close packing, chosen at random."""

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, d), a function of the seed [a0].

        Raises:
            ValueError: when they do not fit.
        """
        (kind,) = species
        walls = tuple(axis for axis, periodic in enumerate(box.periodic) if not periodic)
        return close_packing(kind.count, box.sizes, walls, 2 * kind.radius, seed)


def sphere_volume(diameter: float, dimensions: int) -> float:
    """Volume of a sphere, or area of a disk."""
    return math.pi * diameter**2 * (diameter / 6 if dimensions == 3 else 1 / 4)


def close_packing(
    count: int, lengths: ArrayLike, walls: tuple[int, ...], diameter: float, seed: int
) -> Array:
    """Centres of `count` spheres on randomly chosen sites of a lattice that fills the box.

    The lattice is made of layers across the last axis, (100) layers of a face-centred cubic crystal
    or the rows of a triangular one, stretched to fit the box and as wide as `count` sites allow.

    Args:
        count: number of spheres.
        lengths: of the box, 2 or 3 of them, from wall to wall where there are walls.
        walls: axes that end at hard walls; centres keep half a diameter from them.
        diameter: of the spheres.
        seed: of the choice of sites.

    Returns:
        (count, dimensions).

    Raises:
        ValueError: when no such lattice has room.
    """
    box = np.asarray(lengths, dtype=float)
    axes = range(len(box))
    walled = [axis in walls for axis in axes]
    open_lengths = [box[a] - diameter if walled[a] else box[a] for a in axes]
    if min(open_lengths) < 0:
        raise ValueError(f"box {box.tolist()}: walls nearer than a diameter, {diameter:g}")

    def sites_along(axis: int, spacing: float) -> int:
        """In a layer, whose neighbours are shifted by half the spacing."""
        rows = open_lengths[axis] / spacing + (0.5 if walled[axis] else 0.0)
        return max(int(rows + 1e-12), 1)

    def spacing_along(axis: int, sites: int) -> float:
        rows = sites - 0.5 if walled[axis] else sites
        return float(open_lengths[axis] / rows)

    last = len(box) - 1
    limit = diameter * _TOUCHING
    for stretch in np.geomspace(max(2.0, box.max() / diameter), 1.0, 400):
        sites = [sites_along(axis, limit * stretch) for axis in range(last)]
        gaps = [spacing_along(axis, n) for axis, n in enumerate(sites)]
        if min(gaps) < limit and not all(
            n == 1 and walled[a] for a, n in enumerate(sites) if gaps[a] < limit
        ):
            continue
        offset = math.sqrt(sum((gap / 2) ** 2 for gap in gaps))
        wanted = limit * stretch  # between layers as in them
        height = max(math.sqrt(max(wanted**2 - offset**2, 0.0)), wanted / 2)
        if walled[last]:
            layers = int(open_lengths[last] / height + 1e-12) + 1
            heights = np.linspace(0, open_lengths[last], layers) if layers > 1 else np.zeros(1)
        else:
            layers = int(open_lengths[last] / height + 1e-12) // 2 * 2
            if layers == 0:
                continue
            heights = np.arange(layers) * (open_lengths[last] / layers)
        if math.prod(sites) * layers >= count:
            break
    else:
        volume = float(np.prod([box[a] for a in axes]))
        packing = count * sphere_volume(diameter, len(box)) / volume
        raise ValueError(
            f"{count} spheres of diameter {diameter:g} (packing fraction {packing:.3g}) do not fit "
            f"the box {box.tolist()}"
        )
    rows = [np.arange(n) * gap for n, gap in zip(sites, gaps, strict=True)]
    layer = np.stack(np.meshgrid(*rows, indexing="ij"), axis=-1).reshape(-1, last)
    points = np.empty((layers, len(layer), last + 1))
    for n, height in enumerate(heights):
        points[n, :, :last] = layer + (n % 2) * np.array(gaps) / 2
        points[n, :, last] = height
    every = points.reshape(-1, last + 1)
    chosen = np.sort(np.random.default_rng(seed).permutation(len(every))[:count])
    centres: Array = every[chosen] + np.where(walled, diameter / 2, 0.0)
    return centres[_along_curve(centres / diameter)]


def _along_curve(points: Array) -> NDArray[np.int64]:
    """An order in which points that follow each other are near in space: the Morton curve."""
    codes = np.zeros(len(points), dtype=np.int64)
    places = np.floor(points).astype(np.int64)
    for bit in range(_CURVE_BITS):
        for axis, place in enumerate(places.T):
            codes |= ((place >> bit) & 1) << (bit * places.shape[1] + axis)
    return np.argsort(codes, kind="stable")
