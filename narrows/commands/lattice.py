"""`narrows lattice`: exact, simulated and hydrodynamic shocks of three-state lattice gases."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from narrows.messages import printable

if TYPE_CHECKING:
    from lattice.models import LatticeGas

app = typer.Typer(no_args_is_help=True, help=__doc__)

File = Annotated[
    Path,
    typer.Argument(metavar="FILE", help="model: family, rates, left, right, z1, z2 (TOML or JSON)"),
]
Json = Annotated[Path | None, typer.Option("--json", metavar="OUT", help="write the results here")]
Figures = Annotated[
    Path | None, typer.Option("--figures", metavar="DIR", help="write PNG figures here")
]


LONGEST = 1e9  # time, in inverse units of the rates
MOST = 10_000_000  # sites, cells, runs or samples


def _refuse(message: object) -> NoReturn:
    """One message on stderr, exit code 2."""
    typer.echo(printable(f"narrows lattice: {message}"), err=True)
    raise typer.Exit(2)


def _refusing(command: Callable[..., None]) -> Callable[..., None]:
    """What a user can mend is one message."""

    @functools.wraps(command)
    def refusing(*arguments: Any, **options: Any) -> None:
        try:
            command(*arguments, **options)
        except (ValueError, ArithmeticError, OSError, ImportError) as error:
            _refuse(error)

    return refusing


def _read(path: Path) -> tuple[LatticeGas, float, float]:
    from lattice import spec

    try:
        return spec.read(path)
    except spec.SpecError as error:
        _refuse(error)


def _write(path: Path | None, data: dict[str, Any]) -> None:
    if path is None:
        return
    try:
        path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        _refuse(f"{path}: {error.strerror}")


def _numbers(text: str) -> list[float]:
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        _refuse(f"--times {text}: must be numbers separated by commas")
    if not all(0 <= value <= LONGEST for value in values):
        _refuse(f"--times {text}: must be between 0 and {LONGEST:g}")
    return values


BY_SITE = ("stationary_profile", "stationary_currents", "domain_wall_profile")  # in the JSON only


@app.command()
@_refusing
def check(
    file: File,
    sites: Annotated[int, typer.Option(metavar="L", min=2, help="sites of the full generator")] = 7,
    start: Annotated[
        int | None, typer.Option("--from", metavar="K", help="initial shock position, in sites")
    ] = None,
    times: Annotated[
        str | None,
        typer.Option(metavar="T1,T2", help="times for the mean shock position, in inverse rates"),
    ] = None,
    out: Json = None,
) -> None:
    """Is the product measure stationary, does the shock random-walk, at which rates: exactly."""
    from lattice.check import check as examine

    model, z1, z2 = _read(file)
    moments = None if times is None else _numbers(times)
    report = examine(model, sites, z1, z2, start, moments)
    _write(out, report.as_json())
    for condition in report.conditions:
        typer.echo(f"({condition.equation}) {condition.statement}: off by {condition.residual:.3g}")
    for name, value in report.as_json().items():
        if name not in BY_SITE and name not in ("conditions", "inconsistent_ends", "remarks"):
            typer.echo(f"{name}: {value}")
    for remark in report.remarks:
        typer.echo(f"narrows lattice: {remark}", err=True)
    if report.inconsistent_ends:
        failing = "; ".join(
            f"({c.equation}) {c.statement} fails by {c.residual:.3g}"
            for c in report.inconsistent_ends
        )
        _refuse(f"{file}: inconsistent boundaries: {failing}")


@app.command()
@_refusing
def simulate(
    file: File,
    sites: Annotated[int, typer.Option(metavar="L", min=2, max=MOST)] = 10_000,
    replicas: Annotated[int, typer.Option(min=2, max=MOST, help="independent runs")] = 20,
    time: Annotated[
        float,
        typer.Option(min=0, max=LONGEST, help="length of each run, in inverse rates"),
    ] = 200.0,
    samples: Annotated[
        int, typer.Option(min=3, max=MOST, help="equally spaced samples, first at time 0")
    ] = 41,
    seed: Annotated[int, typer.Option(min=0, help="equal seeds give equal results")] = 1,
    start: Annotated[
        int | None,
        typer.Option("--from", metavar="K", help="initial shock position, in sites; default: L/2"),
    ] = None,
    out: Json = None,
    figures: Figures = None,
) -> None:
    """Follow the shock by kinetic Monte Carlo from |K>: position, v_s, D_s, profile, current."""
    import numpy as np

    from lattice import monte_carlo, shocks

    model, z1, z2 = _read(file)
    start = sites // 2 if start is None else start
    tracked = z1 != z2 and not model.periodic
    ensemble = monte_carlo.simulate(
        model,
        shocks.shock_marginals(model, sites, start, z1, z2),
        np.linspace(0.0, time, samples),
        replicas,
        seed,
        monte_carlo.shock_evidence(model, z1, z2) if tracked else None,
    )
    current, current_error = ensemble.mean_current()
    last = ensemble.occupation[-1]
    data: dict[str, Any] = {
        "sites": sites,
        "replicas": replicas,
        "seed": seed,
        "times": ensemble.times.tolist(),
        "attempted_updates": ensemble.attempts,
        "current": current,
        "current_error": current_error,
        "final_profile": {
            f"rho_{name}": last[:, n].tolist() for n, name in enumerate(model.states) if name != "0"
        },
    }
    typer.echo(f"current of C: {current:.6g} +- {current_error:.2g}")
    if ensemble.positions is not None:
        walk = monte_carlo.estimate_walk(ensemble.times, ensemble.positions)
        d1, d2 = shocks.hopping_rates(model, z1, z2)
        data |= {
            "mean_shock_position": ensemble.positions.mean(axis=0).tolist(),
            "variance_shock_position": ensemble.positions.var(axis=0, ddof=1).tolist(),
            "shock_velocity": walk.velocity,
            "shock_velocity_error": walk.velocity_error,
            "shock_diffusion": walk.diffusion,
            "shock_diffusion_error": walk.diffusion_error,
            "predicted_velocity": d2 - d1,
            "predicted_diffusion": (d1 + d2) / 2,
        }
        typer.echo(
            f"v_s = {walk.velocity:.6g} +- {walk.velocity_error:.2g} "
            f"(bond equations: {d2 - d1:.6g})"
        )
        typer.echo(
            f"D_s = {walk.diffusion:.6g} +- {walk.diffusion_error:.2g} "
            f"(bond equations: {(d1 + d2) / 2:.6g})"
        )
        reach = abs(d2 - d1) * time + 5 * math.sqrt((d1 + d2) * time)
        if reach > min(start, sites - start):
            typer.echo(
                f"narrows lattice: the shock may reach an end within time {time:g} (it moves up to "
                f"{reach:.0f} sites); v_s and D_s then hold no longer",
                err=True,
            )
    _write(out, data)
    if figures is not None:
        from lattice import figures as draw

        draw.simulation(model, ensemble, z1, z2, start, figures)


@app.command()
@_refusing
def hydro(
    file: File,
    times: Annotated[
        str, typer.Option(metavar="T1,T2", help="macroscopic times t' = t/L")
    ] = "0.1,0.2",
    cells: Annotated[int, typer.Option(min=2, max=MOST, help="cells of the Godunov scheme")] = 400,
    sites: Annotated[
        int, typer.Option(metavar="L", min=2, max=MOST, help="sites of the Monte Carlo run")
    ] = 2000,
    replicas: Annotated[
        int, typer.Option(min=0, max=MOST, help="Monte Carlo runs to compare with (0: none)")
    ] = 0,
    seed: Annotated[int, typer.Option(min=0)] = 1,
    out: Json = None,
    figures: Figures = None,
) -> None:
    """Euler-scale solution from the step z1 | z2, domain-wall rates, phase of the open chain."""
    from lattice import shocks
    from lattice.step import evolve_step

    model, z1, z2 = _read(file)
    moments = sorted(set(_numbers(times)))
    residual = max(float(abs(shocks.bond_residual(model, z)).max()) for z in (z1, z2))
    if residual > shocks.CONTRADICTS * model.scale:
        typer.echo(
            f"narrows lattice: {file}: the product measure is not stationary (off by "
            f"{residual:.3g}): j is a mean-field estimate",
            err=True,
        )
    result = evolve_step(model, z1, z2, moments, cells, sites, replicas, seed)
    data = result.as_json()
    _write(out, data)
    for name, value in data.items():
        if not isinstance(value, list):
            typer.echo(f"{name}: {value}")
    if figures is not None:
        from lattice import figures as draw

        draw.hydrodynamics(model, result, z1, z2, figures)
