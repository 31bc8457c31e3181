"""`narrows advise`: what to run for a wished precision."""

import shlex
from typing import TYPE_CHECKING, Annotated

import typer

from lammps_inputs import SceneError
from narrows.markdown import table
from narrows.messages import say, user_errors, warn
from narrows.scene_options import ENGINES, SceneFile, SceneName, Settings, scene_fields, scene_of

if TYPE_CHECKING:
    from narrows.advice import Advice


def advise(
    scene: SceneName,
    quantity: Annotated[str, typer.Option(metavar="NAME", help="as in summary.json")],
    error: Annotated[str, typer.Option(metavar="ERROR", help="2%, or in the quantity's unit")],
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[
        str | None, typer.Option(metavar=ENGINES, help="default: the best of the chart")
    ] = None,
    calibration: Annotated[
        float, typer.Option(min=1.0, metavar="SECONDS", help="time of the calibration")
    ] = 20.0,
) -> None:
    """Say which settings, how long and how many runs give a quantity with this standard error."""
    with user_errors():
        from narrows.advice import advise as advice_of  # here, so that `--help` stays fast

        chosen = scene_of(scene, file, settings)
        fixed = scene_fields(scene, file, settings)
        if "=" in error:
            raise SceneError.of_field("error", error, "must be as 2% or 0.001")
        advice = advice_of(
            chosen, f"{quantity}={error}", fixed, engine, calibration, report=lambda text: say(text)
        )
        _tell(advice, fixed)


def _tell(advice: "Advice", fixed: dict[str, object]) -> None:
    measured, setting = advice.calibration, advice.setting
    system = advice.scene.system
    rows = [
        ("engine", advice.engine),
        ("calibration", f"{advice.precision.told(measured.estimate)}"),
        ("", f"{measured.sampled:g} t0 in {measured.seconds:.0f} s, {1 / measured.pace:.3g} t0/s"),
    ]
    if system.solvent:
        rows.insert(1, ("collision time", f"{system.solvent.collision_time:g} t0"))
    if system.clock.steps_per_collision > 1:
        rows.insert(2, ("MD steps a collision", str(system.clock.steps_per_collision)))
    if setting:
        deviation = f"{setting.deviation:+.1%} +- {setting.deviation_error:.1%}"
        rows.append(("chart (docs/pareto.md)", f"{setting}: off by {deviation}"))
    rows += [
        ("runs", f"{advice.repeats} of {advice.scene.duration:g} t0"),
        ("time on this machine", _clock(advice.wall_seconds)),
    ]
    say(table(("", f"{advice.precision.quantity} to {advice.precision}"), rows))
    warn(_warnings(advice))
    if advice.another_fluid:
        ratio = (
            (setting.error_after_10_s / advice.another_fluid.error_after_10_s) ** 2
            if setting
            else 1
        )
        say(
            f"where only v_s n_f nu matters: {advice.another_fluid} needs {ratio:.2g} times less "
            "time; compare speeds times n_f nu"
        )
    say(f"\n{_command(advice, fixed)}")


def _warnings(advice: "Advice") -> list[str]:
    setting, precision = advice.setting, advice.precision
    if setting is None:
        return [
            f"no setting of {advice.scene.name} was measured for {precision.quantity}: the "
            "scene's own are taken, and only the statistical error is planned"
        ]
    if precision.relative and setting.accuracy >= precision.error:
        return [
            f"the chart knows {setting} to be right to {setting.accuracy:.1%} only: "
            f"{precision} is the statistical error"
        ]
    return []


def _clock(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _command(advice: "Advice", fixed: dict[str, object]) -> str:
    """The command that does it; `--until` holds the promise where the calibration was lucky."""
    scene = advice.scene
    changed = {**fixed, **(advice.setting.fields if advice.setting else {})}
    changed["duration"] = scene.duration
    words = ["narrows", "run" if advice.repeats == 1 else "sweep", scene.name]
    words += ["--engine", advice.engine]
    for name in changed:
        words += ["--set", f"{name}={getattr(scene, name)}"]
    if advice.repeats > 1:
        words += ["--repeats", str(advice.repeats)]
    wish = f"{advice.precision.error:.6g}"
    if advice.precision.relative:
        wish = f"{100 * advice.precision.error:.6g}%"
    words += ["--until", f"{advice.precision.quantity}={wish}", "--out", "DIR"]
    return shlex.join(words)
