"""Accuracy against run time of suspensions, both couplings: `accuracy.py` for the scene `claylike`.

    python benchmarks/pareto_suspensions.py --out runs/pareto-suspensions [--quick] [--jobs 2]
        [--page docs/pareto.md]

Numbers are those of the laboratory: D over (18) of a lone sphere, the speed in the frame of zero
volume flux over Stokes's (16), so fluids of other density and mean free path may be compared. The
price is that of tau_D (20), in which a sphere diffuses by its diameter. The truth is that of the
last setting of each study, with shorter MD steps or a larger box.
"""

from typing import Any

from accuracy import (
    CONVERGED,
    Fields,
    Quantity,
    Setting,
    Study,
    Summary,
    arguments,
    entry,
    full_table,
    measure,
    plain,
    setting,
)
from analysis.estimate import Estimate
from analysis.suspension_diffusion import TERMS
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.markdown import replace_block

BUDGET, QUICK_BUDGET = 5.0, 2.0  # processor seconds of a setting

SHARE = 32  # of a run is the longest lag: a quarter of an eighth
LONG = 2  # budgets, for lags of 50 collisions

APART: Fields = {"surface_potential": 0.05, "kappa": 1e8, "peclet": 2.0}  # they repel each other
TOUCHING: Fields = {"potential": "hertz", "volume_fraction": 0.3, "peclet": 2.0}
CELL: Fields = {"cells": 10, "equilibration": 100.0}
REFLECTION: Fields = {"coupling": "reflection", "cells": 16, "equilibration": 300.0}
NUMPY: Fields = {"cells": 12, "lubrication": "off", "md_steps_per_collision": 30}


def claylike(scene: Scene) -> Claylike:
    assert isinstance(scene, Claylike)
    return scene


def diffusion_time(scene: Scene) -> float:
    """tau_D (20) [t0]."""
    model = claylike(scene).model
    return model.suspension.time_scales().diffusion / model.time_unit


def alone(scene: Scene) -> float:
    """D of a lone sphere (18), kBT = 1 [a0^2/t0]."""
    model = claylike(scene).model
    return model.suspension.diffusion_coefficient * model.time_unit / model.cell**2


def diffusion(summary: Summary, scene: Scene) -> Estimate:
    """Without the images of the box, over (18); of lags of 50 collisions."""
    longest = summary["sampled_time"] / SHARE
    wanted = TERMS * claylike(scene).mean_free_path
    if longest < 0.9 * wanted:
        return Estimate(None, None, f"lags of {longest:.2g} of {wanted:g} t0 tell too little")
    return entry(summary, "diffusion.infinite_box").scaled(1 / alone(scene))


def speed(summary: Summary, scene: Scene) -> Estimate:
    """v_s over that of a lone sphere, Pe D / R."""
    clay = claylike(scene)
    stokes = clay.peclet * alone(scene) / clay.model.reduced_radius
    return entry(summary, "settling_speed.zero_volume_flux").scaled(1 / stokes)


def quantities(truth: Setting) -> tuple[Quantity, ...]:
    return (
        Quantity("diffusion", diffusion, truth),
        Quantity("settling speed", speed, truth),
        Quantity("g(r), highest peak", plain("radial_distribution.peak_height"), truth),
        *temperatures(),
    )


def temperatures() -> tuple[Quantity, ...]:
    return (
        Quantity("fluid temperature", plain("temperature"), 1.0),
        Quantity("colloid temperature", plain("colloid_temperature"), 1.0),
    )


def study(
    name: str, fields: Fields, settings: tuple[Setting, ...], truth: Setting, **more: Any
) -> Study:
    """With the truth as its last setting."""
    return Study(
        "claylike",
        fields,
        settings,
        quantities(truth),
        converged=truth,
        name=name,
        unit=("tau_D", diffusion_time),
        **more,
    )


def steps(*numbers: int, budgets: int = 1) -> tuple[Setting, ...]:
    return each("md_steps_per_collision", *numbers, budgets=budgets)


def each(name: str, *values: float | str, budgets: int = 1) -> tuple[Setting, ...]:
    return tuple(Setting("mpc", ((name, value),), budgets) for value in values)


def flights(*values: float, steps: float, budgets: int = 1) -> tuple[Setting, ...]:
    """Mean free paths with steps of the same time, so many in a0."""
    return tuple(
        setting("mpc", budgets, mean_free_path=value, md_steps_per_collision=round(steps * value))
        for value in values
    )


FINE_CELL = setting("mpc", CONVERGED // 4, md_steps_per_collision=536)
FINE_REFLECTION = setting("mpc", CONVERGED // 4, md_steps_per_collision=222)
STUDIES = (
    study(
        "II, apart",
        APART | CELL,
        (
            *steps(30, 67, 134, 268, budgets=LONG),
            *each("density", 10, 20, 40, 120, budgets=LONG),
            *flights(0.1, 0.25, 1.0, steps=536, budgets=LONG),
            *each("lubrication", "off", budgets=LONG),
        ),
        FINE_CELL,
    ),
    study(
        "II, touching",
        TOUCHING | CELL,
        (
            *steps(67, 134, 268),
            *each("closest", 0.01, 0.1, 0.3),
            *each("lubrication", "off"),
        ),
        FINE_CELL,
    ),
    study(
        "II, box",
        APART | CELL,
        (*each("cells", 7, 8, 10, budgets=LONG), *each("cells", 12, budgets=2 * LONG)),
        setting("mpc", 4 * LONG, cells=16),
    ),
    study(
        "I, apart",
        APART | REFLECTION,
        (
            *steps(20, 55, 111),
            *each("density", 1.5, 5, 10),
            *flights(0.15, 0.3, 1.2, steps=185),
            *each("lubrication", "off"),
            *each("placement", "nearest"),
        ),
        FINE_REFLECTION,
    ),
    study(
        "I, touching",
        TOUCHING | REFLECTION,
        (
            *steps(55, 111, budgets=LONG),
            *each("closest", 0.01, 0.1, 0.3, budgets=LONG),
            *each("lubrication", "off", budgets=LONG),
            *each("placement", "nearest", budgets=LONG),
        ),
        FINE_REFLECTION,
    ),
    study(
        "I, box",
        APART | REFLECTION,
        (*each("cells", 14, 16), *each("cells", 20, 24, budgets=2 * LONG)),
        setting("mpc", CONVERGED // 4, cells=32),
    ),
    Study(
        "claylike",
        TOUCHING | REFLECTION | NUMPY | {"equilibration": 20.0, "sampling_interval": 1.2},
        tuple(setting("reference", 3, N_max=most) for most in (1, 2, 4, 10)),
        temperatures(),
        name="I, touching",
        unit=("tau_D", diffusion_time),
    ),
)


def main() -> None:
    parser = arguments(__doc__)
    options = parser.parse_args()
    budget = QUICK_BUDGET if options.quick else BUDGET
    results = measure(STUDIES, options.out, budget, options.jobs)
    if options.page:
        replace_block(options.page, "suspensions", full_table(results))


if __name__ == "__main__":
    main()
