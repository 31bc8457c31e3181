"""Accuracy against run time of fluids and of colloids in a channel: `accuracy.py`.

    python benchmarks/pareto.py --out runs/pareto [--quick] [--jobs 2] [--page docs/pareto.md]
        [--chart narrows/chart.json]

Errors of wall slip are in units of v_max.
"""

import json
from collections.abc import Callable
from pathlib import Path

from accuracy import (
    CONVERGED,
    Quantity,
    Study,
    Summary,
    arguments,
    chart_of,
    entry,
    full_table,
    measure,
    plain,
    setting,
)
from analysis.estimate import Estimate
from lammps_inputs import Scene
from lammps_inputs.scenes.channel import Channel
from lammps_inputs.viscosity import solvent_viscosity
from narrows.markdown import replace_block
from run_files.writing import replace_text

BUDGET, QUICK_BUDGET = 6.0, 2.0  # processor seconds of a setting
CAREFUL = 8  # budgets of settings that differ by little


def theory_of(scene: Scene) -> float:
    """Kinematic viscosity by kinetic theory [a0^2/t0]."""
    system = scene.system
    assert system.solvent is not None
    return solvent_viscosity(system.solvent, system.box.dimensions).total


def relative(name: str) -> Callable[[Summary, Scene], Estimate]:
    """A viscosity over that of kinetic theory."""

    def measure(summary: Summary, scene: Scene) -> Estimate:
        return entry(summary, name).scaled(1 / theory_of(scene))

    return measure


def channel_of(scene: Scene) -> Channel:
    """The scene of a study of colloids."""
    assert isinstance(scene, Channel)
    return scene


def speed_over_gravity(summary: Summary, scene: Scene) -> Estimate:
    """v_s / g: linear response [t0]."""
    return entry(summary, "settling_speed").scaled(1 / channel_of(scene).gravity)


def inverse_drag(summary: Summary, scene: Scene) -> Estimate:
    """v_s n_f nu / (M_c g): in units of the fluid's viscosity, so that fluids may be compared."""
    channel = channel_of(scene)
    fluid = channel.density * theory_of(scene)
    return speed_over_gravity(summary, scene).scaled(fluid / channel.colloid_mass)


def mobility(summary: Summary, scene: Scene) -> Estimate:
    """kBT v / (M_c g) in the frame at rest, which Einstein's relation says is D [a0^2/t0]."""
    channel = channel_of(scene)
    if not channel.gravity:
        return entry(summary, "diffusion")
    force = channel.colloid_mass * channel.gravity
    return entry(summary, "settling_speed_rest").scaled(1 / force)


PAPER = setting("mpc", CONVERGED, md_steps_per_collision=30)
ONE_COLLOID = setting("mpc", CONVERGED, gravity=0.1)
FLUID = ("density", "collision_time")
STUDIES = (
    Study(
        "bulk",
        {"length": 96, "width": 32, "shear_wave": 0.4, "sampling_interval": 0.5, "duration": 60},
        (
            *(setting("srd", collision_time=tau) for tau in (0.05, 0.1, 0.2, 0.5)),
            *(setting("srd", density=density) for density in (3, 30)),
            *(setting("mpc", collision_time=tau) for tau in (0.05, 0.1, 0.2, 0.5)),
            *(setting("mpc", density=density) for density in (3, 30)),
            setting("mpc", collision_time=0.5, density=30, sampling_interval=1.0),
            setting("mpc", thermostat="none"),
            setting("mpc", precision="single"),
            setting("mpc", width=16, duration=20),
            setting("reference"),
        ),
        (Quantity("viscosity, shear wave", relative("viscosity"), 1.0, key="viscosity"),),
        stationary=False,
    ),
    Study(
        "poiseuille",
        {"length": 25, "width": 25, "gravity": 0.004, "equilibration": 300},
        (
            *(setting("srd", collision_time=tau) for tau in (0.05, 0.1, 0.2)),
            setting("srd", density=3),
            *(setting("mpc", collision_time=tau) for tau in (0.05, 0.1, 0.2)),
            *(setting("mpc", density=density) for density in (3, 30)),
            *(setting("mpc", gravity=gravity) for gravity in (0.001, 0.01)),
            setting("srd", gravity=0.001),
            setting("mpc", collision_time=0.02),
            setting("mpc", precision="single"),
            setting("mpc", width=50, gravity=0.001, equilibration=1000),
            setting("reference", equilibration=150),
        ),
        (
            Quantity(
                "viscosity, Poiseuille curvature",
                relative("viscosity_curvature"),
                1.0,
                key="viscosity_curvature",
            ),
            Quantity("wall slip", plain("wall_slip", 0.01), 0.0),
        ),
    ),
    Study(
        "channel",
        {"equilibration": 50},
        (
            *(setting("mpc", CAREFUL, md_steps_per_collision=steps) for steps in (15, 5, 3, 1)),
            setting("mpc", CAREFUL, precision="single"),
            setting("mpc", gravity=0.3, md_steps_per_collision=5),
            *(
                setting("mpc", thermostat=thermostat)
                for thermostat in ("none", "monte_carlo", "maxwell_boltzmann")
            ),
            *(setting("mpc", density=density) for density in (5, 20)),
            *(
                setting("mpc", collision_time=tau, md_steps_per_collision=steps)
                for tau, steps in ((0.03, 10), (0.06, 20), (0.06, 3), (0.1, 33))
            ),
            setting("srd"),
            setting("srd", md_steps_per_collision=5),
            setting("srd", collision_time=0.06, md_steps_per_collision=20),
            setting("reference", md_steps_per_collision=5, equilibration=5),
        ),
        (
            Quantity("settling speed", speed_over_gravity, PAPER, FLUID),
            Quantity("inverse drag", inverse_drag, PAPER, key="settling_speed"),
            Quantity("fluid temperature", plain("temperature"), 1.0, key="temperature"),
            Quantity(
                "colloid temperature",
                plain("colloid_temperature"),
                1.0,
                key="colloid_temperature",
            ),
        ),
        converged=PAPER,
    ),
    Study(
        "channel",
        {"equilibration": 50, "colloids": 1, "gravity": 0.0},
        (
            setting("mpc"),
            setting("mpc", md_steps_per_collision=5),
            setting("srd"),
            setting("srd", md_steps_per_collision=5),
        ),
        (Quantity("colloid diffusion", mobility, ONE_COLLOID, key="diffusion"),),
        converged=ONE_COLLOID,
    ),
)


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--chart", type=Path, help="file of the chart that `narrows advise` reads")
    options = parser.parse_args()
    budget = QUICK_BUDGET if options.quick else BUDGET
    results = measure(STUDIES, options.out, budget, options.jobs)
    if options.page:
        replace_block(options.page, "pareto", full_table(results))
    if options.chart:
        replace_text(options.chart, json.dumps(chart_of(results), indent=1) + "\n")


if __name__ == "__main__":
    main()
