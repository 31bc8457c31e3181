"""Where fluids and colloids in a channel hold and break: `stability_map.py`.

    python benchmarks/stability.py --out runs/stability [--axis tau_MD ...] [--long] [--jobs 2]
                                   [--page docs/stability.md]

The exit code is 1 when a point breaks without a word.
"""

import math
import sys

from analysis import Estimate
from lammps_inputs import Scene
from lammps_inputs.scenes.channel import Channel
from lammps_inputs.viscosity import viscosity
from stability_map import (
    COLLOID_TEMPERATURE,
    FLUID_TEMPERATURE,
    Axis,
    Criterion,
    Fields,
    Summary,
    arguments,
    draw_map,
)

LINEAR = 0.33  # v_s / g in the linear regime [t0]
CHANNEL: Fields = {"duration": 300, "equilibration": 20}
SHEAR_WAVE: Fields = {"length": 96, "width": 32, "shear_wave": 0.6}


def over_theory(summary: Summary, scene: Scene) -> Estimate:
    """The viscosity of a shear wave over that of kinetic theory."""
    entry = summary["viscosity"]
    found, theory = Estimate.of_json(entry), entry["theory"]
    if not theory:
        return Estimate(None, None, found.reason or "theory has none")
    return found / float(theory)


def over_linear(summary: Summary, scene: Scene) -> Estimate:
    """The settling speed over what it is in proportion to gravity."""
    assert isinstance(scene, Channel)
    return Estimate.of_json(summary["settling_speed"]) / (LINEAR * scene.gravity)


VISCOSITY = Criterion("viscosity", 0.1, 0.5, over_theory)
MOBILITY = Criterion("settling_speed / g", 0.1, 0.5, over_linear)


def shear_wave(collision_time: float = 0.1, density: float = 10, angle: float = 90) -> Fields:
    """A decaying wave, sampled and followed according to kinetic theory's decay time."""
    theory = viscosity(density, collision_time, min(angle, 179.9))
    decay_time = 1 / (theory * (2 * math.pi / SHEAR_WAVE["width"]) ** 2)
    return SHEAR_WAVE | {
        "collision_time": collision_time,
        "density": density,
        "angle": angle,
        "sampling_interval": max(2 * collision_time, 0.05 * decay_time),
        "duration": max(60 * collision_time, 3 * decay_time),
    }


def time_step(value: float, duration: float = 400) -> Fields:
    """tau_MD at a collision time of 0.06, or one step a collision where it is longer."""
    collision_time = max(0.06, value)
    return {
        "collision_time": collision_time,
        "md_steps_per_collision": round(collision_time / value),
        "colloids": 5,
        "gravity": 0.0,
        "duration": duration,
        "equilibration": duration / 10,
    }


def slit(value: float) -> Fields:
    """A slit of that width; where it must be, the walls are nearer than the usual 2 a0."""
    return CHANNEL | {"width": value, "wall_sigma": min(2.0, value / 2), "gravity": 0.0}


def channel_collision_time(value: float) -> Fields:
    steps = min(1000, round(value / 0.001))
    return CHANNEL | {
        "collision_time": value,
        "md_steps_per_collision": steps,
        "gravity": 0.0,
        "sampling_interval": max(0.75, 2 * value),
    }


AXES = (
    Axis(
        "tau_MD",
        "channel",
        (0.001, 0.004, 0.01, 0.02, 0.03, 0.06, 0.075, 0.1, 0.2),
        time_step,
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "tau_MD (reference)",
        "channel",
        (0.02, 0.06, 0.2),
        lambda value: time_step(value, duration=50),
        (COLLOID_TEMPERATURE,),
        "reference",
    ),
    Axis(
        "gravity",
        "channel",
        (0.1, 0.2, 0.3, 0.5, 1, 2, 3, 10, 100, 1e4),
        lambda value: CHANNEL | {"gravity": value},
        (MOBILITY,),
    ),
    Axis(
        "density, colloids",
        "channel",
        (0.1, 0.3, 1, 2, 3, 5, 10, 20, 50, 100, 200),
        lambda value: CHANNEL | {"density": value, "duration": min(300, 3000 / value)},
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "density, fluid",
        "bulk",
        (0.1, 0.3, 0.5, 1, 2, 3, 5, 10, 20, 50, 100, 200),
        lambda value: shear_wave(density=value),
        (VISCOSITY,),
    ),
    Axis(
        "angle",
        "bulk",
        (1, 3, 10, 30, 60, 90, 120, 150, 170, 177, 179, 180),
        lambda value: shear_wave(angle=value),
        (VISCOSITY,),
    ),
    Axis(
        "collision time, fluid",
        "bulk",
        (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2, 3, 10),
        lambda value: shear_wave(collision_time=value),
        (VISCOSITY,),
    ),
    Axis(
        "collision time, colloids",
        "channel",
        (0.001, 0.003, 0.015, 0.05, 0.1, 0.3, 1, 3, 10),
        channel_collision_time,
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "colloid radius",
        "channel",
        (0.05, 0.1, 0.2, 0.3, 0.5, 1, 2, 3, 4, 4.9),
        lambda value: (
            CHANNEL
            | {"colloid_radius": value, "gravity": 0.0, "duration": 2000 if value > 3 else 300}
        ),
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "wall strength",
        "channel",
        (0, 1e-8, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8),
        lambda value: CHANNEL | {"wall_strength": value, "width": 5},
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "colloids in 40 x 10",
        "channel",
        (1, 3, 5, 7, 8, 9, 10, 11),
        lambda value: CHANNEL | {"colloids": int(value)},
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "width",
        "channel",
        (4.0, 4.001, 4.01, 4.05, 4.1, 4.3, 4.5, 5, 6, 8, 10),
        slit,
        (COLLOID_TEMPERATURE,),
    ),
)
LONG = (
    Axis(
        "MD steps",
        "channel",
        (1e5, 1e6, 1e7),
        lambda value: {"duration": value * 0.001 - 20, "equilibration": 20},
        (COLLOID_TEMPERATURE,),
    ),
    Axis(
        "MD steps, no thermostat",
        "channel",
        (1e5, 1e6, 1e7),
        lambda value: {
            "duration": value * 0.001 - 20,
            "equilibration": 20,
            "thermostat": "none",
        },
        (FLUID_TEMPERATURE,),
    ),
)


def main() -> int:
    parser = arguments(__doc__)
    parser.add_argument("--long", action="store_true", help="also runs of up to 1e7 MD steps")
    options = parser.parse_args()
    return draw_map((*AXES, *(LONG if options.long else ())), options, "table")


if __name__ == "__main__":
    sys.exit(main())
