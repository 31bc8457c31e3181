"""`summary.json` and the figures of a run; `docs/analysis.md` says what every key means."""

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import blocking, chain, figures, flow, health
from analysis.blocking import Estimate
from analysis.diffusion import diffusion
from analysis.pair_correlation import pair_correlation
from analysis.run_directory import RunDirectory, RunDirectoryError
from analysis.settling import settling_series
from analysis.shear_wave import decay_viscosity, wave_amplitude
from analysis.temperature import colloid_temperature

Array = NDArray[np.float64]

BIN_WIDTH = 0.1  # of g(x) [a0]; the 48-24 repulsion is about that steep


@dataclass
class Results:
    """What was found so far: entries of summary.json, and figures by file name."""

    summary: dict[str, Any]
    figures: dict[str, Figure] = field(default_factory=dict)


def analyze(directory: str | Path) -> dict[str, Any]:
    """Analyses a run and writes summary.json and the figures into its directory.

    Args:
        directory: of the run, finished or in progress.

    Returns:
        the content of summary.json.

    Raises:
        RunDirectoryError: when it is no run directory, or nothing lies after the equilibration.
        OSError: when the results cannot be written.
    """
    run = RunDirectory(directory)
    results = Results(_whole_run(run))
    if run.manifest["scene"] == "bulk":
        if run.number("shear_wave") > 0:
            _shear_wave(run, results)
    else:
        _slit_flow(run, results)
    if run.has_colloids:
        _colloids(run, results)
    results.summary["warnings"] = list(_warnings(run, results.summary))
    results.summary["figures"] = sorted(results.figures)
    for name, figure in results.figures.items():
        figure.savefig(run.path / name, dpi=150)
    _write_json(run.path / "summary.json", results.summary)
    return results.summary


def summary_of(directory: Path) -> dict[str, Any]:
    """The summary of a finished run, analysed unless that was done since it finished."""
    file, progress = directory / "summary.json", directory / "progress.json"
    if file.is_file() and file.stat().st_mtime >= progress.stat().st_mtime:
        content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        return content
    return analyze(directory)


def estimates(summary: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Every entry with a value and an error; nested ones by their path, `diffusion.exponent`."""
    found: dict[str, dict[str, Any]] = {}
    for key, entry in summary.items():
        if isinstance(entry, dict):
            if "value" in entry:
                found[key] = entry
            found |= {f"{key}.{name}": inner for name, inner in estimates(entry).items()}
    return found


def _whole_run(run: RunDirectory) -> dict[str, Any]:
    """What every scene has."""
    observables = run.observables
    used = run.sampled(observables.steps)
    temperature = blocking.mean(observables.fluid_temperature[used])
    return {
        "scene": run.manifest["scene"],
        "engine": run.manifest["engine"],
        "finished": run.finished(),
        "simulated_time": float(run.times(observables.steps)[-1]),
        "sampled_time": int(used.sum()) * run.interval,
        "frames": int(used.sum()),
        "wall_seconds": run.wall_seconds(),
        "fluid_particles": run.manifest["fluid_particles"],
        "colloids": run.manifest["colloids"],
        "temperature": temperature.as_json(),
    }


def _warnings(run: RunDirectory, summary: dict[str, Any]) -> Iterator[str]:
    """What the run shows that no correct simulation would; empty for a healthy one."""
    fluid = Estimate(**summary["temperature"])
    if not run.has_colloids:
        yield from health.temperature_warnings(fluid, None)
        return
    yield from health.temperature_warnings(fluid, Estimate(**summary["colloid_temperature"]))
    yield from health.overlap_warnings(
        run.colloids.positions, run.number("length"), 2 * run.number("colloid_radius")
    )


def _with_theory(viscosity: Estimate, run: RunDirectory) -> dict[str, Any]:
    return viscosity.as_json() | {"theory": run.viscosity_theory}


def _slit_flow(run: RunDirectory, results: Results) -> None:
    """Profile and Reynolds number; where gravity drives the fluid, the parabola's viscosity."""
    fluid, width = run.fluid_profile, run.number("width")
    used = run.sampled(fluid.steps)
    counts, velocity = fluid.counts[used], fluid.velocity_x[used]
    fit = None
    if run.manifest["scene"] == "poiseuille":
        gravity = run.number("gravity")
        try:
            v_max, v_wall = flow.fit_parabola(fluid.y, width, counts, velocity)
        except ValueError as error:
            raise RunDirectoryError(f"{run.path / 'fluid_profile.dat'}: {error}") from None
        fit = (float(v_max.mean()), float(v_wall.mean()))
        maximum = blocking.mean(v_max)
        viscosity = _poiseuille_viscosity(maximum, gravity, width)
        curvature = _poiseuille_viscosity(blocking.mean(v_max - v_wall), gravity, width)
        results.summary["maximum_velocity"] = maximum.as_json()
        results.summary["viscosity"] = _with_theory(viscosity, run)
        results.summary["viscosity_curvature"] = curvature.as_json()
        results.summary["wall_slip"] = _ratio(v_wall, v_max).scaled(100).as_json()
    mean_velocity = blocking.mean(flow.mean_velocity(counts, velocity))
    if run.viscosity_theory is None:
        reynolds = Estimate(None, None, "kinetic theory has no viscosity for this fluid")
    else:
        reynolds = mean_velocity.scaled(flow.reynolds_number(1.0, width, run.viscosity_theory))
    results.summary["fluid_velocity"] = mean_velocity.as_json()
    results.summary["reynolds_number"] = reynolds.as_json()
    mean_profile = flow.momentum_profile(counts, velocity).mean(axis=0)
    results.figures["profile.png"] = figures.profile(fluid.y, mean_profile, width, fit)


def _poiseuille_viscosity(maximum: Estimate, gravity: float, width: float) -> Estimate:
    """nu = g L_y^2 / (8 v_max), tabatabaei-2009 (3.15), with the error of v_max carried over.

    With v_max counted from the velocity at the walls it is nu = -g / v_x'', right with slip too.
    """
    assert maximum.value is not None
    if gravity == 0:
        return Estimate(None, None, "no gravity")
    if maximum.value * gravity <= 0:
        return Estimate(None, None, "the fluid does not flow along gravity")
    value = gravity * width**2 / (8 * maximum.value)
    error = None if maximum.error is None else value * maximum.error / abs(maximum.value)
    return Estimate(value, error, maximum.reason)


def _ratio(numerator: Array, denominator: Array) -> Estimate:
    """Ratio of two time means, its error to first order in the fluctuations of both."""
    below = float(denominator.mean())
    if below == 0:
        return Estimate(None, None, "no flow")
    ratio = float(numerator.mean()) / below
    deviation = blocking.mean((numerator - ratio * denominator) / below)
    return Estimate(ratio, deviation.error, deviation.reason)


def _shear_wave(run: RunDirectory, results: Results) -> None:
    fluid, width = run.fluid_profile, run.number("width")
    used = run.sampled(fluid.steps)
    amplitude = wave_amplitude(fluid.y, width, fluid.counts, fluid.velocity_x)
    viscosity = decay_viscosity(amplitude[used], run.interval, run.fluid_looks, width)
    results.summary["viscosity"] = _with_theory(viscosity, run)
    results.figures["shear_wave.png"] = figures.wave_decay(
        run.times(fluid.steps),
        amplitude,
        run.equilibration_time,
        viscosity,
        width,
    )


def _colloids(run: RunDirectory, results: Results) -> None:
    colloids = run.colloids
    used = colloids.steps >= run.equilibration_steps
    if used.sum() < 2:
        raise RunDirectoryError(
            f"{run.path / 'trajectory.lammpsdump'}: no two frames after the equilibration: it ends "
            f"at step {run.equilibration_steps}, the trajectory at step {colloids.steps[-1]}"
        )
    mass = run.manifest.get("colloid_mass")
    if not isinstance(mass, int | float) or not mass > 0:
        raise RunDirectoryError(f"{run.path / 'manifest.json'}: colloid_mass must be positive")
    _settling(run, results)
    temperature = blocking.mean(colloid_temperature(colloids.velocities[used], mass))
    results.summary["colloid_temperature"] = temperature.as_json()

    order = chain.head_order(colloids.positions[0, :, 0], run.number("gravity"))
    x, y = colloids.positions[:, order, 0], colloids.positions[:, order, 1]
    times = run.times(colloids.steps)
    _diffusion(run, results, x[used], colloids.velocities[used][:, order, 0])
    results.figures["space_time.png"] = figures.space_time(
        times, x, run.number("length"), run.equilibration_time
    )
    if len(order) >= 2:
        _spacings(run, results, x, used)
        _pair_correlation(run, results, x[used])
    if len(order) >= 3:
        _zigzag(run, results, y, used)


def _settling(run: RunDirectory, results: Results) -> None:
    series = settling_series(run)
    moving, rest = (blocking.mean(v[series.used]) for v in (series.co_moving, series.rest))
    results.summary["settling_speed"] = moving.as_json()
    results.summary["settling_speed_rest"] = rest.as_json()
    results.figures["settling_speed.png"] = figures.settling(
        series.times, series.rest, series.co_moving, run.equilibration_time
    )


def _diffusion(run: RunDirectory, results: Results, x: Array, velocity: Array) -> None:
    try:
        found = diffusion(x, velocity, run.interval)
    except ValueError as error:
        results.summary["diffusion"] = {"value": None, "error": None, "reason": str(error)}
        return
    results.summary["diffusion"] = {
        **found.from_msd.as_json(),
        "from_vacf": found.from_vacf.as_json(),
        "exponent": found.exponent.as_json(),
        "subdiffusive": found.subdiffusive,
        "window": list(found.window),
    }
    results.figures["diffusion.png"] = figures.diffusion(found)


def _spacings(run: RunDirectory, results: Results, x: Array, used: NDArray[np.bool_]) -> None:
    spacings = chain.neighbour_spacings(x)
    groups = chain.group_spacings(spacings)
    results.summary["spacings"] = {
        "neighbours": spacings[used].mean(axis=0).tolist(),
        "groups_initial": groups[0].tolist(),
        "groups": groups[used].mean(axis=0).tolist(),
        "groups_final": groups[-1].tolist(),
        "left_out_at_tail": spacings.shape[1] % chain.GROUP,
    }
    if groups.shape[1]:
        results.figures["spacings.png"] = figures.spacings(
            run.times(run.colloids.steps), groups, run.equilibration_time
        )


def _zigzag(run: RunDirectory, results: Results, y: Array, used: NDArray[np.bool_]) -> None:
    width = run.number("width")
    amplitude, local = chain.zigzag_amplitude(y, width), chain.local_zigzag(y)
    displacement = float(np.sqrt(((y[used] - width / 2) ** 2).mean()))
    results.summary["zigzag"] = {
        "amplitude_rms": _root(blocking.mean(amplitude[used] ** 2)).as_json(),
        "displacement_rms": displacement,
        "uncorrelated_rms": displacement / np.sqrt(y.shape[1]),
        "local_rms": np.sqrt((local[used] ** 2).mean(axis=0)).tolist(),
    }
    results.figures["zigzag.png"] = figures.zigzag(
        run.times(run.colloids.steps),
        amplitude,
        local,
        run.equilibration_time,
    )


def _root(square: Estimate) -> Estimate:
    """Square root of an estimate that is not negative, its error to first order."""
    assert square.value is not None
    value = float(np.sqrt(square.value))
    error = square.error
    if error is not None and value > 0:
        error /= 2 * value
    return Estimate(value, error, square.reason)


def _pair_correlation(run: RunDirectory, results: Results, x: Array) -> None:
    distance, g = pair_correlation(x, run.number("length"), BIN_WIDTH)
    peak = int(np.argmax(g))
    results.summary["pair_correlation"] = {
        "peak_position": float(distance[peak]),
        "peak_height": float(g[peak]),
        "bin_width": float(distance[1] - distance[0]),
    }
    results.figures["pair_correlation.png"] = figures.pair_correlation(
        distance, g, 2 * run.number("colloid_radius")
    )


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Writes beside the file and renames, so that no reader sees half of it."""
    partial = path.with_name(path.name + ".partial")
    partial.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    os.replace(partial, path)
