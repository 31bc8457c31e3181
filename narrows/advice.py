"""Settings, length and number of runs for a wished precision.

The chart (`narrows/chart.py`) says which settings are right and which of them is fastest; a short
calibration on this machine says how fast, and how much one unit of time tells about the quantity.
"""

import math
import tempfile
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis import Estimate
from analysis.analyze import analyze, estimates
from analysis.precision import Precision
from lammps_inputs import Scene, SceneError, all_engines
from lammps_inputs.deck import check_engine
from lammps_inputs.engines import default_engine
from narrows.chart import ChartedSetting, best, charted
from narrows.until import precisions_of
from srd_driver import RunError, Simulation
from srd_driver.sweep import available_cores

FIRST_SAMPLES = 40  # sampling intervals of the first look of a calibration
PATIENCE = 4  # times the calibration's time, for an error that is not known yet


@dataclass(frozen=True)
class Calibration:
    """A short run on this machine.

    Attributes:
        seconds: it took, wall time [s].
        pace: wall time for a unit of simulated time [s/t0].
        sampled: time after the equilibration [t0].
        estimate: of the quantity.
    """

    seconds: float
    pace: float
    sampled: float
    estimate: Estimate


@dataclass(frozen=True)
class Advice:
    """What to run.

    Attributes:
        scene: with the duration of each run.
        engine: by name.
        precision: asked for.
        setting: of the chart; None where the chart has nothing of the quantity.
        another_fluid: a setting that is faster where only the product v_s n_f nu matters.
        calibration: on this machine.
        repeats: runs, of as many seeds, to be run at once.
        wall_seconds: expected.
    """

    scene: Scene
    engine: str
    precision: Precision
    setting: ChartedSetting | None
    another_fluid: ChartedSetting | None
    calibration: Calibration
    repeats: int
    wall_seconds: float


def advise(
    scene: Scene,
    wish: str,
    fixed: Collection[str] = (),
    engine: str | None = None,
    calibration_seconds: float = 20.0,
    cores: int | None = None,
    report: Callable[[str], Any] | None = None,
) -> Advice:
    """What to run for a quantity's precision, as `settling_speed=2%`.

    Args:
        scene: what is to be simulated.
        fixed: fields that must stay as they are.
        engine: by name; default: the best of the chart.
        calibration_seconds: wall time of the calibration, about [s].
        cores: runs at a time; default: those of this machine.
        report: called with a line before each step.

    Raises:
        SceneError: for a wrong wish or engine.
        RunError: when the calibration cannot tell the quantity's error.
    """
    (precision,) = precisions_of([wish], scene)
    able = [engine] if engine else [each for each in all_engines() if _can(scene, each)]
    known = charted(scene.name, precision.quantity, able, fixed)
    same = [each for each in known if not each.is_another_fluid]
    relative = precision.error if precision.relative else math.inf
    setting = best(same, relative)
    chosen = setting.engine if setting else engine or default_engine(scene.system)
    if setting:
        scene = type(scene).make(**(scene.model_dump() | setting.fields))
    calibration = calibrate(scene, chosen, precision, calibration_seconds, report)
    error = _statistical(precision, calibration.estimate, setting)
    sampled = calibration.sampled * (calibration.estimate.normal_error / error) ** 2
    cores = cores or available_cores()
    repeats, duration = _shares(scene, sampled, calibration, cores)
    rounds = math.ceil(repeats / cores)
    return Advice(
        scene.lasting(duration),
        chosen,
        precision,
        setting,
        _faster_fluid(known, setting, relative),
        calibration,
        repeats,
        rounds * calibration.pace * (scene.equilibration + duration),
    )


def calibrate(
    scene: Scene,
    engine: str,
    precision: Precision,
    seconds: float,
    report: Callable[[str], Any] | None = None,
) -> Calibration:
    """Run the scene for about so many seconds of wall time, or until the error is known.

    Raises:
        RunError: when the error is not known after `PATIENCE` times that.
    """
    system = scene.system
    duration = FIRST_SAMPLES * system.clock.sample_steps * system.clock.time_step
    if _is_transient(scene):
        duration = scene.duration  # a decay is measured whole
    began, steps_before, pace = time.perf_counter(), 0, 0.0
    with tempfile.TemporaryDirectory(prefix="narrows-") as folder:
        while True:
            if report:
                report(f"calibration of {engine} over {duration:g} t0")
            longer = scene.lasting(duration)
            with Simulation(longer, engine, Path(folder), resume=True) as simulation:
                steps_before, started = simulation.step, time.perf_counter()
                simulation.finish()
                ran = (simulation.step - steps_before) * system.clock.time_step
                pace = (time.perf_counter() - started) / ran
            found = estimates(analyze(folder))
            if precision.quantity not in found:
                known = ", ".join(found)
                raise RunError(f"{precision.quantity}: the run tells only {known}")
            estimate = Estimate.of_json(found[precision.quantity])
            spent = time.perf_counter() - began
            told = bool(estimate.error) and estimate.reason is None
            if told and (spent >= seconds or _is_transient(scene)):
                return Calibration(spent, pace, duration, estimate)
            if spent >= PATIENCE * seconds:
                raise RunError(
                    f"{precision.told(estimate)} after {duration:g} t0 and {spent:.0f} s: the "
                    "calibration is too short; give it a longer --calibration"
                )
            duration = _round_up(duration * min(3.0, max(1.5, seconds / spent)))


def _is_transient(scene: Scene) -> bool:
    """Whether a run is a decay, which more runs tell better, and a longer run does not."""
    solvent = scene.system.solvent
    return solvent is not None and solvent.shear_wave > 0


def _can(scene: Scene, engine: str) -> bool:
    try:
        check_engine(scene, engine)
    except SceneError:
        return False
    return True


def _statistical(precision: Precision, estimate: Estimate, setting: ChartedSetting | None) -> float:
    """The statistical error that leaves room for what the setting may be off, absolute."""
    error = precision.error * (abs(estimate.number) if precision.relative else 1.0)
    off = setting.accuracy * abs(estimate.number) if setting else 0.0
    return math.sqrt(error**2 - off**2) if off < error else error


def _shares(
    scene: Scene, sampled: float, calibration: Calibration, cores: int
) -> tuple[int, float]:
    """Number of runs and the duration of each: as many as there are cores, none shorter than the
    calibration, whose error was known."""
    if _is_transient(scene):
        return math.ceil(sampled / calibration.sampled), scene.duration
    repeats = max(1, min(cores, int(sampled / calibration.sampled)))
    return repeats, _round_up(max(sampled / repeats, calibration.sampled))


def _faster_fluid(
    known: Collection[ChartedSetting], setting: ChartedSetting | None, error: float
) -> ChartedSetting | None:
    other = best((each for each in known if each.is_another_fluid), error)
    if other is None or setting is None or not other.is_right:
        return None
    return other if other.error_after_10_s < setting.error_after_10_s else None


def _round_up(duration: float) -> float:
    """To two digits."""
    unit: float = 10.0 ** (math.floor(math.log10(duration)) - 1)
    return float(f"{math.ceil(duration / unit * (1 - 1e-12)) * unit:.12g}")
