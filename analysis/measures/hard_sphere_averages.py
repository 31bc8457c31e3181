"""Averages of hard spheres beside what is known of them: equation of state, contact density."""

import math

import numpy as np

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.colors import blocks_of, estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = (
    "temperature",
    "collision_rate",
    "compressibility",
    "lower_pressure",
    "upper_pressure",
    "contact_density",
)

FITTED = 0.2  # from a wall, where the density is extrapolated to contact [a0]


def carnahan_starling(packing: float) -> float:
    """Z = P V / (N kBT) of the bulk; N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635."""
    return (1 + packing + packing**2 - packing**3) / (1 - packing) ** 3


def measure(run: RunDirectory) -> Findings:
    """Means of the table; Z beside theory in bulk, wall pressure beside the contact density."""
    table, kind = run.table(), run.species()
    used = run.sampled(table.steps)
    entries = {
        name: correlated_mean.mean(table[name][used], run.interval).as_json()
        for name in table.columns
    }
    if not run.manifest.system.walls:
        volume = math.prod(run.box.sizes)
        packing = kind.count * 4 / 3 * math.pi * kind.radius**3 / volume
        entries["compressibility"]["theory"] = carnahan_starling(packing)
        return Findings(entries)
    entries["contact_density"] = contact_density(run)
    return Findings(entries)


def contact_density(run: RunDirectory) -> dict[str, object]:
    """Number density at both walls, from the logarithm's cubic: P / kBT by the sum rule."""
    wall = run.manifest.system.walls[0]
    bins = run.bins("colors", ("Ncount",))
    width = float(np.diff(bins.positions).mean())
    area = float(np.prod(np.delete(run.box.sizes, wall.axis)))
    distance = bins.positions - bins.positions[0] + width / 2
    near = distance < FITTED

    def at_contact(number: Array, count: Array) -> Array:
        both = (number + number[::-1])[near] / (2 * count * width * area)
        constant = np.polynomial.polynomial.polyfit(distance[near], np.log(both), 3)[0]
        return np.asarray(np.exp(constant))

    blocks = blocks_of(run, len(bins.steps))
    sums = np.array([bins["Ncount"][block].mean(axis=0) for block in blocks])
    return estimate(at_contact, sums, np.ones(len(sums))).as_json()
