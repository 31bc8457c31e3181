"""The runs behind the figures of lane formation, and what their summaries say.

The paper runs 5000 time units twice at each field, from the field before. At full quality these are
ladders too, of shorter runs: lanes settle within 1000 time units. For `--quick` each run begins at
rest, from a crystal, and is too short for phi. docs/reproduce.md says what that costs.
"""

from collections.abc import Iterable, Mapping, Sequence

from analysis.analyze import summary_of
from analysis.estimate import Estimate
from lammps_inputs import Scene, make_scene
from narrows.papers.figure import Column, Directories, Quality

CRYSTAL = 1.03
FLUID = 0.75
ALL = "lane_order"  # phi by all disks in a lane
PHI = "lane_order_near"  # the reading of phi that has the paper's numbers (docs/errata.md)
UP, DOWN = 1, 2  # seeds
ALIKE = ("dimension", "density", "thermostat", "seed")  # what the runs of a ladder share
MELTED = 1.25  # field above which a configurational run needs short steps to last
CONFIGURATIONAL_STEPS = {  # up to which rate of shear; longer runs break where short ones do not
    "quick": ((1, 0.001), (2, 0.0005), (4, 0.0002), (5, 0.0001)),
    "full": ((1, 0.001), (2, 0.0005), (3, 0.0002), (4, 0.0001)),
}
THERMOSTATS = {
    "kinetic": "kinetic energy",
    "configurational": "configurational temperature",
    "kinetic_x": "kinetic energy along the field",
    "kinetic_y": "kinetic energy across it",
}


def disks(density: float, field: float, thermostat: str, quality: Quality, seed: int = UP) -> Scene:
    """896 soft disks in a field; seed `DOWN` on a ladder's way down."""
    quick = quality == "quick"
    if thermostat == "kinetic":
        equilibration, duration = (150.0, 100.0) if quick else (1000.0, 1500.0)
        step = 0.002 if field <= 10 else 0.001  # as right at half the price (docs/lanes.md)
    elif quick:
        equilibration, duration = 50.0, 50.0
        step = 0.001 if field <= 4 else 0.0005
    else:  # 0.001 lasted for 420 time units at n = 0.75, F = 4 (docs/reproduce.md)
        equilibration, duration = (300.0, 700.0) if field <= MELTED else (100.0, 200.0)
        step = 0.001 if field <= MELTED else 0.0002 if field <= 4 else 0.0001
    return make_scene(
        "lanes",
        density=density,
        field=field,
        thermostat=thermostat,
        time_step=step,
        sampling_interval=2.0 if quick else 5.0,
        equilibration=equilibration,
        duration=duration,
        seed=seed,
    )


def spheres(field: float, thermostat: str, quality: Quality) -> Scene:
    """1000 Weeks-Chandler-Andersen spheres in a field."""
    quick = quality == "quick"
    step, equilibration, duration = (0.001, 40.0, 40.0) if quick else (0.001, 400.0, 600.0)
    if thermostat != "kinetic" and field >= 4:
        step, equilibration, duration = (0.0005, 40.0, 40.0) if quick else (0.0002, 100.0, 200.0)
    return make_scene(
        "lanes",
        dimension=3,
        field=field,
        thermostat=thermostat,
        time_step=step,
        sampling_interval=2.0 if quick else 5.0,
        equilibration=equilibration,
        duration=duration,
    )


def sheared(rate: float, thermostat: str, quality: Quality) -> Scene:
    """1000 of the spheres, sheared; a step of a ladder of rates."""
    quick = quality == "quick"
    step = 0.001 if rate <= 10 else 0.0002
    if thermostat == "configurational":
        steps = CONFIGURATIONAL_STEPS[quality]
        step = next((step for largest_rate, step in steps if rate <= largest_rate), 0.00004)
    brief = quick or (thermostat == "configurational" and rate > 5)  # 6 breaks after 20 time units
    return make_scene(
        "shear",
        rate=rate,
        thermostat=thermostat,
        time_step=step,
        sampling_interval=0.2,
        equilibration=2.0 if brief else 20.0,
        duration=6.0 if brief else 40.0,
    )


def ladders_of(scenes: Iterable[Scene], key: str) -> list[list[Scene]]:
    """Scenes that differ in a field only, `rate` for one, each chain from the lowest on."""
    chains: dict[str, list[Scene]] = {}
    for scene in dict.fromkeys(scenes):
        fields = scene.model_dump()
        chain = {name: fields[name] for name in ALIKE if name in fields}
        chains.setdefault(repr(chain), []).append(scene)
    return [sorted(chain, key=lambda scene: getattr(scene, key)) for chain in chains.values()]


def number(directories: Directories, scene: Scene, key: str) -> Estimate:
    """A number of the run's summary, `current` for one; none of a run that stopped."""
    if scene not in directories:
        return Estimate(None, None, "its run stopped")
    return Estimate.of_json(summary_of(directories[scene].path)[key])


def numbers(directories: Directories, scenes: Iterable[Scene], key: str) -> list[Estimate]:
    """The same number of several runs."""
    return [number(directories, scene, key) for scene in scenes]


def columns(series: Mapping[str, Sequence[Estimate]]) -> dict[str, Column]:
    """Of a figure's table: each number and its error, by its key."""
    table: dict[str, Column] = {}
    for key, values in series.items():
        table[key] = [each.value for each in values]
        table[f"{key}_error"] = [each.error for each in values]
    return table


def largest(values: Sequence[Estimate]) -> Estimate:
    """The one with the largest value; where some are missing a lower bound, without an error."""
    known = [each for each in values if each.value is not None]
    if not known:
        return values[0]
    top = max(known, key=lambda each: each.number)
    if len(known) == len(values):
        return top
    stopped = f"a lower bound: {len(values) - len(known)} of {len(values)} runs stopped"
    return Estimate(top.value, None, stopped)
