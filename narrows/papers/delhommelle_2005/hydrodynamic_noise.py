"""Beyond the paper: do lanes form when the noise is hydrodynamic?

The same disks in an MPC fluid, with hydrodynamics and without, and under noise that the paper
names: Langevin's, of NEBD, and that of dissipative pairs (VI). A field is F sigma / kBT; times
differ by the diffusion of a lone disk, whose runs are as long in sigma^2/D.
"""

from matplotlib.figure import Figure

from analysis.estimate import Estimate
from lammps_inputs import Scene, make_scene
from narrows.papers.delhommelle_2005.state_points import CRYSTAL, FLUID, PHI, columns, numbers
from narrows.papers.drawing import points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, claimed, measured

NOISE, SIZE = "beyond-noise", "beyond-size"
SOLVENT = {"on": "hydrodynamic", "shuffle": "shuffled solvent", "bath": "bath"}
OTHERS = {"langevin": "Langevin", "dpd": "dissipative pairs"}
NAMES = SOLVENT | OTHERS
KEYS = (
    *("current", "colour_structure", "lane_order", PHI, "number_variance"),
    *("configurational_temperature", "kinetic_temperature", "stream_temperature"),
)
VISCOUS = {"solvent_density": 10.0, "mass": 10.0, "collision_time": 0.02, "time_step": 0.005}
FRICTION = 10.0  # of Langevin's noise and of pairs: D of a lone disk is 0.1, 30 times the bath's


def noisy(
    noise: str, density: float, field: float, quality: Quality, particles: int | None = None
) -> Scene:
    """Disks in a field under one of the noises."""
    quick = quality == "quick"
    number = particles or (224 if quick else 896)
    fields = {"particles": number, "density": density, "field": field}
    if noise in OTHERS:
        return make_scene(
            "lanes",
            **fields,
            thermostat=noise,
            friction=FRICTION,
            sampling_interval=0.5,
            equilibration=30.0,
            duration=70.0,
        )
    return make_scene(
        "lanes",
        **fields,
        **VISCOUS,
        solvent="mpc",
        hydrodynamics=noise,
        sampling_interval=5.0,
        equilibration=1000.0 if quick else 2000.0,
        duration=500.0 if quick else 2000.0,
    )


def _points(quality: Quality) -> list[tuple[float, float]]:
    """Densities and fields."""
    fields = (2.0, 5.0) if quality == "quick" else (0.5, 1.0, 2.0, 5.0)
    return [(n, f) for n in (0.5, FLUID, CRYSTAL) for f in fields]


def _driven(quality: Quality) -> dict[tuple[str, float, float], Scene]:
    return {
        (noise, n, f): noisy(noise, n, f, quality) for noise in NAMES for n, f in _points(quality)
    }


def _figure_noise(directories: Directories, quality: Quality) -> Outcome:
    scenes = _driven(quality)
    series = {key: numbers(directories, scenes.values(), key) for key in KEYS}
    of = {key: dict(zip(scenes, values, strict=True)) for key, values in series.items()}
    densities = sorted({n for _, n, _ in scenes})
    panels = ("colour_structure", "configurational_temperature", "number_variance")
    figure = Figure(figsize=(4.0 * len(panels), 3.4 * len(densities)), layout="constrained")
    grid = figure.subplots(len(densities), len(panels), squeeze=False)
    for row, density in zip(grid, densities, strict=True):
        for axes, key in zip(row, panels, strict=True):
            for place, (noise, name) in enumerate(NAMES.items()):
                fields = [f for other, n, f in scenes if (other, n) == (noise, density)]
                values = [of[key][noise, density, f] for f in fields]
                points(axes, fields, values, place, label=name, linestyle="-", linewidth=0.6)
            axes.set(xlabel=r"field $F\sigma/k_BT$", xscale="log", title=f"n = {density:g}")
            axes.set_ylabel(key.replace("_", " "))
        row[0].set_yscale("log")
    grid[0][0].legend()
    table: dict[str, Column] = {
        "noise": [noise for noise, _, _ in scenes],
        "density": [n for _, n, _ in scenes],
        "field": [f for _, _, f in scenes],
    }
    return Outcome(figure, table | columns(series), _results(of))


def _results(of: dict[str, dict[tuple[str, float, float], Estimate]]) -> list[Result]:
    strongest = max(f for _, _, f in of["current"])
    results: list[Result] = []
    for density in sorted({n for _, n, _ in of["current"]}):
        place = f"n = {density:g}, F = {strongest:g}"
        for noise, name in NAMES.items():
            for key in ("colour_structure", "lane_order", PHI, "configurational_temperature"):
                value = of[key][noise, density, strongest]
                results.append(measured(NOISE, f"{key}, {name}, {place}", value))
        bath, fluid = (of["colour_structure"][h, density, strongest] for h in ("bath", "on"))
        results.append(
            claimed(
                NOISE,
                f"colour_structure in a bath less that with hydrodynamics, {place}",
                bath - fluid,
                "noise of hydrodynamic origin keeps colours from parting (V, VI)",
                "positive",
            )
        )
        bath, fluid = (of["number_variance"][h, density, strongest] for h in ("bath", "on"))
        results.append(
            claimed(
                NOISE,
                f"number_variance with hydrodynamics less that in a bath, {place}",
                fluid - bath,
                "it brings inhomogeneities and jamming instead (V, VI)",
                "positive",
            )
        )
    return results


def _sizes(quality: Quality) -> dict[int, Scene]:
    sizes = (224, 504) if quality == "quick" else (224, 896, 3584, 8064)
    field = 5.0 if quality == "quick" else 2.0
    return {number: noisy("on", FLUID, field, quality, number) for number in sizes}


def _figure_size(directories: Directories, quality: Quality) -> Outcome:
    scenes = _sizes(quality)
    series = {key: numbers(directories, scenes.values(), key) for key in KEYS}
    shares = [
        each.scaled(1 / number)
        for number, each in zip(scenes, series["colour_structure"], strict=True)
    ]
    figure = Figure(figsize=(8.4, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    points(left, list(scenes), shares)
    points(right, list(scenes), series["current"])
    left.set(xlabel="disks", ylabel=r"colour structure over $N$", xscale="log", ylim=(0, None))
    right.set(xlabel="disks", ylabel="current", xscale="log", ylim=(0, None))
    table: dict[str, Column] = {"particles": list(scenes)}
    return Outcome(
        figure,
        table | columns(series),
        [
            measured(SIZE, f"colour_structure over N, hydrodynamic, {number} disks", share)
            for number, share in zip(scenes, shares, strict=True)
        ],
    )


FIGURES = (
    PaperFigure(
        NOISE,
        "Parting of colours, T_conf and unevenness under five noises; the fluid's is hydrodynamic.",
        _figure_noise,
        lambda quality: list(_driven(quality).values()),
        partial=True,
    ),
    PaperFigure(
        SIZE,
        "Parting of colours and current in the MPC fluid, by the number of disks.",
        _figure_size,
        lambda quality: list(_sizes(quality).values()),
        partial=True,
    ),
)
