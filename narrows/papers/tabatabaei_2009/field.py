"""Figs. 4.9 and 4.10: three colloids in 40 x 10 under ever stronger gravity."""

import numpy as np

from analysis import correlated_mean, flow
from analysis.depletion import wall_depletion
from analysis.estimate import Estimate
from lammps_inputs.scenes.channel import Channel
from lammps_inputs.viscosity import viscosity
from narrows.papers.drawing import SPEED, one_panel, paper_line, paper_remark, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, claimed, compared, measured
from narrows.papers.tabatabaei_2009.state_points import (
    Point,
    channel_point,
    fit,
    scenes_of,
    speed,
)

SLOPE = PaperNumber.printed("0.34")
WIDE, NARROW = 2.0, 1.2  # sigma_w
WANDERING = (
    "below 0 as far as the colloids wander off the mid-line, where they are slower, the more the "
    "weaker gravity is: rms_off_mid_line_a0 in the data of Fig. 4.10"
)
GRAVITY = "gravity $g$  [$a_0/t_0^2$]"


def _gravities(quality: Quality) -> list[float]:
    if quality == "quick":
        return [0.04, 0.1, 0.2]
    return [round(0.02 * step, 2) for step in range(1, 11)]


def field_points(wall_sigma: float, quality: Quality) -> list[Point]:
    """One point for each gravity."""
    seeds = 8 if quality == "full" else 2
    first_seed = 1 if wall_sigma == WIDE else 101  # else the same until a colloid meets a wall
    return [
        channel_point(40, 3, seeds, first_seed=first_seed, gravity=gravity, wall_sigma=wall_sigma)
        for gravity in _gravities(quality)
    ]


def _reynolds(directories: Directories, point: Point) -> Estimate:
    """(4.11) of the fluid's mean velocity and the viscosity of theory."""
    velocities = []
    for scene in point.scenes:
        run = directories[scene]
        fluid = run.profile()
        used = run.sampled(fluid.steps)
        velocities.append(flow.mean_velocity(fluid.counts[used], fluid.velocity_x[used]))
    scene = point.scenes[0]
    nu = viscosity(scene.density, scene.collision_time, scene.angle)
    scale = flow.reynolds_number(1.0, scene.width, nu)
    return correlated_mean.mean(velocities).scaled(scale)


def _figure_4_9(directories: Directories, quality: Quality) -> Outcome:
    gravities = _gravities(quality)
    numbers = [_reynolds(directories, point) for point in field_points(WIDE, quality)]
    line = fit(gravities, numbers)
    figure, axes = one_panel(GRAVITY, r"Reynolds number  $\langle v \rangle L_y / \nu$")
    points(axes, gravities, numbers, label="40 x 10, three colloids")
    ends = np.array([0.0, 0.21])
    axes.plot(
        ends, line[0].number + line[1].number * ends, label=f"line, slope {line[1].number:.3f}"
    )
    paper_remark(axes, 0.05, 0.72, "thesis: linear in $g$,\nand well below 1")
    axes.set(xlim=(0, 0.21), ylim=(0, None))
    axes.legend(loc="upper left")
    strongest = numbers[-1]
    results = [
        measured("4.9", "Reynolds number at g = 0.2", strongest),
        claimed(
            "4.9",
            "1 less the Reynolds number at g = 0.2",
            1 - strongest,
            "small enough for laminar flow",
            "positive",
        ),
        claimed(
            "4.9",
            "Reynolds number at g = 0 of a line through the points",
            line[0],
            "proportional to g",
            "zero",
            WANDERING,
        ),
    ]
    table: dict[str, Column] = {
        "gravity": gravities,
        "reynolds_number": [number.value for number in numbers],
        "error": [number.error for number in numbers],
    }
    return Outcome(figure, table, results)


def _well_at_the_wall(scene: Channel) -> float:
    """Depth of the potential of mean force of a colloid near one wall [kBT]."""
    fluid, wall = scene.colloid_fluid, scene.colloid_wall
    distances = np.linspace(0.5, scene.width / 2, 400)
    depletion = [wall_depletion(fluid.energy, fluid.cutoff, y, scene.density) for y in distances]
    return float(-(np.array(depletion) + wall.energy(distances)).min())


def _figure_4_10(directories: Directories, quality: Quality) -> Outcome:
    gravities = _gravities(quality)
    speeds = {
        sigma: [speed(directories, point) for point in field_points(sigma, quality)]
        for sigma in (WIDE, NARROW)
    }
    wide, narrow = ([entry.co_moving for entry in entries] for entries in speeds.values())
    figure, axes = one_panel(GRAVITY, SPEED)
    for number, (sigma, entries) in enumerate(((WIDE, wide), (NARROW, narrow))):
        points(axes, gravities, entries, number, label=rf"$\sigma_w$ = {sigma:g}")
    intercept, slope = fit(gravities, wide)
    ends = np.array([0.0, 0.21])
    label = rf"our fit for $\sigma_w$ = 2: slope {slope.number:.3f}"
    axes.plot(ends, intercept.number + slope.number * ends, color="0.25", label=label)
    paper_line(axes, ends, SLOPE.value * ends, "thesis: slope 0.34")
    axes.set(xlim=(0, 0.21), ylim=(0, None))
    axes.legend(loc="upper left")
    results = [
        compared("4.10", "slope dv_s/dg, sigma_w = 2.0 [t0]", slope, SLOPE),
        measured(
            "4.10",
            "v_s at g = 0 of the line, sigma_w = 2.0 [a0/t0]",
            intercept,
            WANDERING,
        ),
        measured(
            "4.10",
            "v_s at g = 0.1, sigma_w = 2.0 [a0/t0]",
            wide[gravities.index(0.1)],
            "0.034 if the thesis' line of slope 0.34, whose intercept is not printed, begins at 0",
        ),
    ]
    if len(gravities) > 3:
        results += [
            claimed(
                "4.10",
                "coefficient of g^2, sigma_w = 2.0 [t0^3/a0]",
                fit(gravities, wide, 2)[2],
                "perfect linear increase",
                "zero",
            ),
            measured(
                "4.10", "coefficient of g^2, sigma_w = 1.2 [t0^3/a0]", fit(gravities, narrow, 2)[2]
            ),
        ]
    results.append(
        measured(
            "4.10",
            "v_s at g = 0.2, sigma_w = 1.2 less 2.0 [a0/t0]",
            narrow[-1] - wide[-1],
            "the thesis: a small deviation from the line for sigma_w = 1.2",
        )
    )
    results += [
        measured(
            "4.10",
            f"depth of the well at the wall that depletion makes, sigma_w = {sigma:.1f} [kBT]",
            Estimate(_well_at_the_wall(point.scenes[0]), 0.0),
            "exact: the MPC fluid is an ideal gas, and presses a colloid to a wall that lets the "
            "colloid come closer than the colloid lets the fluid",
        )
        for sigma in (WIDE, NARROW)
        for point in field_points(sigma, quality)[:1]
    ]
    table: dict[str, Column] = {
        "gravity": gravities,
        **{
            f"{name}_sigma_w_{sigma:g}": column
            for sigma, entries in speeds.items()
            for name, column in (
                ("v_s", [entry.co_moving.value for entry in entries]),
                ("v_s_error", [entry.co_moving.error for entry in entries]),
                ("rms_off_mid_line_a0", [entry.off_mid_line for entry in entries]),
            )
        },
    }
    return Outcome(figure, table, results)


FIGURES = (
    PaperFigure(
        "4.9",
        "Reynolds number of the fluid against gravity, 40 x 10, three colloids.",
        _figure_4_9,
        lambda quality: scenes_of(field_points(WIDE, quality)),
    ),
    PaperFigure(
        "4.10",
        "Settling speed against gravity for two diameters of the wall's repulsion.",
        _figure_4_10,
        lambda quality: scenes_of([*field_points(WIDE, quality), *field_points(NARROW, quality)]),
    ),
)
