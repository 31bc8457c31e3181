"""Where suspensions hold and break, in both couplings: `stability_map.py` for the scene `claylike`.

    python benchmarks/stability_suspensions.py --out runs/stability-suspensions [--axis NAME ...]
                                               [--jobs 2] [--page docs/stability.md]

The exit code is 1 when a point breaks without a word.
"""

import sys
from collections.abc import Callable
from typing import Any

from analysis import Estimate
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from pareto_suspensions import alone, claylike, speed
from stability_map import (
    COLLOID_TEMPERATURE,
    FLUID_TEMPERATURE,
    Axis,
    Criterion,
    Fields,
    Summary,
    arguments,
    draw_map,
    over,
)

DILUTE = {"cell": 2.84, "reflection": 1.0}  # D over (18), by narrows reproduce hecht-2005
SETTLING = {"cell": 2.15, "reflection": 0.68}  # over Stokes, by pareto_suspensions.py
FREE = 2.57  # of coupling II without any forces, here at the default edge of a cell

AT_CONTACT = 2.48  # g of hard spheres at 0.3, (1 - phi / 2) / (1 - phi)^3

CELL: Fields = {"cells": 10, "duration": 120, "equilibration": 30}
REFLECTION: Fields = {"coupling": "reflection", "cells": 16, "duration": 300, "equilibration": 60}
BASES = {"II": CELL, "I": REFLECTION}
APART: Fields = {"surface_potential": 0.05, "kappa": 1e8}  # they repel each other
LONELY: Fields = {"potential": "none", "lubrication": "off", "md_steps_per_collision": 1}
COLLISIONS = 1000  # of lonely colloids


def diffusion(summary: Summary, scene: Scene) -> Estimate:
    """Without the images of the box, over what it is at the defaults."""
    unit = DILUTE[claylike(scene).coupling] * alone(scene)
    return Estimate.of_json(summary["diffusion"]["infinite_box"]) / unit


def settling(summary: Summary, scene: Scene) -> Estimate:
    """Over what it is at a Peclet number of 2."""
    return speed(summary, scene) / SETTLING[claylike(scene).coupling]


def settling_free(summary: Summary, scene: Scene) -> Estimate:
    """Over what it is at the default edge of a cell."""
    return speed(summary, scene) / FREE


def nearest(summary: Summary, scene: Scene) -> Estimate:
    """The highest peak of g(r) over the diameter."""
    found, diameter = summary["radial_distribution"], 2 * claylike(scene).model.reduced_radius
    return Estimate(found["peak_position"] / diameter, 0.5 * found["bin_width"] / diameter)


def sheared(summary: Summary, scene: Scene) -> Estimate:
    """The rate of shear of the colloids over that of the walls."""
    found = summary["shear_flow"]
    return Estimate.of_json(found["rate"]) / float(found["imposed"])


ROTATIONAL = Criterion("rotational_temperature", 0.05, 0.5, over("rotational_temperature"))
TEMPERATURES = {
    "II": (FLUID_TEMPERATURE, COLLOID_TEMPERATURE),
    "I": (FLUID_TEMPERATURE, COLLOID_TEMPERATURE, ROTATIONAL),
}
DIFFUSION = Criterion("D", 0.2, 0.5, diffusion)
SPEED = Criterion("settling_speed / Pe", 0.1, 0.5, settling)
FREE_SPEED = Criterion("settling_speed / Pe", 0.2, 0.5, settling_free)
PLACE = Criterion("place of the peak of g(r) / 2 R", 0.1, 0.3, nearest)
HARD = Criterion(
    "peak of g(r), hard spheres", 0.2, 0.4, over("radial_distribution.peak_height", AT_CONTACT)
)
RATE = Criterion("rate of shear", 0.1, 0.5, sheared)


def axis(
    coupling: str,
    name: str,
    values: tuple[float | str, ...],
    fields: Callable[[Any], Fields],
    *criteria: Criterion,
    engine: str = "mpc",
) -> Axis:
    """Of a coupling: what varies, upon its base, and what must be 1 beside temperatures."""
    return Axis(
        f"{coupling}: {name}",
        "claylike",
        values,
        lambda value: BASES[coupling] | fields(value),
        (*TEMPERATURES[coupling], *criteria),
        engine,
    )


def lonely(mean_free_path: float = 0.5, collisions: int = COLLISIONS, **more: Any) -> Fields:
    """Coupling II without any forces, for as many collisions."""
    return LONELY | {
        "volume_fraction": 0.05,
        "mean_free_path": mean_free_path,
        "sampling_interval": 2 * mean_free_path,
        "equilibration": 0.1 * collisions * mean_free_path,
        "duration": collisions * mean_free_path,
        **more,
    }


def flight(value: float) -> Fields:
    """Coupling I with a mean free path, MD steps of the same time, for 500 collisions."""
    return {
        "mean_free_path": value,
        "md_steps_per_collision": max(1, round(185 * value)),
        "sampling_interval": max(1.0, 2 * value),
        "equilibration": 100 * value,
        "duration": 500 * value,
    }


def edge(value: float) -> Fields:
    """Spheres that reflect, of a radius of 1 / value cells."""
    return {
        "cell_edge": value * Claylike.make().radius,
        "cells": max(10, round(8 / value)),
        "potential": "hertz",
        "equilibration": 30,
        "duration": 150,
    }


def lubricated(value: float | str) -> Fields:
    """Smallest gap of lubrication [R]."""
    return {"lubrication": "off"} if value == "off" else {"closest": value}


def between_walls(value: float) -> Fields:
    """Spheres that repel each other, until the flow is steady."""
    return APART | {
        "boundaries": "bottom",
        "shear_rate": value,
        "equilibration": 100,
        "duration": 400,
    }


def soft(value: float) -> Fields:
    """Spheres that only repel each other, in contact, by so much."""
    return {"potential": "hertz", "volume_fraction": 0.3, "hertz": value}


def large(value: float) -> Fields:
    """Coupling II with a radius of 1 / value cells, at about the same speed in cells."""
    return {
        "cell_edge": value * Claylike.make().radius,
        "cells": 12,
        "potential": "none",
        "lubrication": "off",
        "md_steps_per_collision": 1,
        "peclet": 3 / value,
        "duration": 400,
    }


def field(name: str, **more: Any) -> Callable[[Any], Fields]:
    return lambda value: {name: value, **more}


STEPS = (10, 20, 60, 111, 268)
KAPPAS = (1e7, 2e7, 1e8, 1e9, 1e12)
POTENTIALS = (0.0, 0.02, 0.05, 1.0)
DEPTHS = (0.01, 1, 6, 50, 200)
CONTACTS = (1e-3, 1, 10, 60, 600, 6e4, 6e6)
FRICTIONS = (0, 10, 1e3, 1e4)
GAPS = (1e-3, 3e-3, 0.03, 0.3, "off")
PECLETS = (1, 3, 10, 30, 100)
RATES = (0.003, 0.03, 0.1, 0.2, 0.3)
AXES = (
    axis("II", "MD steps", STEPS, field("md_steps_per_collision")),
    axis(
        "II",
        "M",
        (1, 1.1, 2, 5, 20, 60),
        lambda value: lonely(density=value),
        DIFFUSION,
    ),
    axis(
        "II",
        "mean free path",
        (0.02, 0.1, 0.25, 0.5, 1, 3, 10),
        lambda value: lonely(mean_free_path=value),
        DIFFUSION,
    ),
    axis(
        "II",
        "cell edge [R]",
        (0.4, 0.6, 0.8, 1, 1.6, 3),
        large,
        FREE_SPEED,
    ),
    axis("II", "cells", (4, 5, 7, 10), field("cells")),
    axis(
        "II",
        "volume fraction",
        (1e-3, 0.05, 0.14, 0.3, 0.5, 0.6),
        field("volume_fraction"),
    ),
    axis("II", "lubrication from [R]", GAPS, lubricated),
    axis("II", "kappa [1/m]", KAPPAS, field("kappa")),
    axis("II", "Psi_0 [V]", POTENTIALS, field("surface_potential")),
    axis("II", "depth of the minimum [kBT]", DEPTHS, field("minimum_depth"), PLACE),
    axis("II", "K [kBT]", CONTACTS, soft, HARD),
    axis("II", "friction", FRICTIONS, field("friction")),
    axis("II", "Pe", PECLETS, field("peclet", **APART, duration=300), SPEED),
    axis("II", "rate of shear", RATES, between_walls, RATE),
    axis("I", "MD steps", STEPS, field("md_steps_per_collision")),
    axis("I", "M", (1, 1.1, 1.5, 2.5, 10, 50), field("density")),
    axis("I", "mean free path", (0.02, 0.1, 0.3, 0.6, 1, 3), flight),
    axis("I", "placement", ("entry", "nearest"), field("placement")),
    axis(
        "I",
        "N_max (reference)",
        (1, 2, 4, 10),
        field(
            "N_max",
            cells=12,
            potential="hertz",
            volume_fraction=0.3,
            lubrication="off",
            md_steps_per_collision=30,
            sampling_interval=1.2,
            equilibration=10,
            duration=100,
        ),
        engine="reference",
    ),
    axis("I", "cell edge [R]", (0.3, 0.5, 0.75, 1, 1.1), edge),
    axis("I", "cells", (10, 14, 20), field("cells")),
    axis("I", "volume fraction", (1e-3, 0.05, 0.14, 0.3, 0.5), field("volume_fraction")),
    axis("I", "lubrication from [R]", GAPS, lubricated),
    axis("I", "kappa [1/m]", KAPPAS, field("kappa")),
    axis("I", "Psi_0 [V]", POTENTIALS, field("surface_potential")),
    axis("I", "depth of the minimum [kBT]", DEPTHS, field("minimum_depth")),
    axis("I", "K [kBT]", CONTACTS, soft, HARD),
    axis("I", "friction", FRICTIONS, field("friction")),
    axis("I", "Pe", PECLETS, field("peclet", **APART, duration=1000), SPEED),
    axis("I", "rate of shear", RATES, between_walls, RATE),
)


def main() -> int:
    return draw_map(AXES, arguments(__doc__).parse_args(), "suspensions")


if __name__ == "__main__":
    sys.exit(main())
