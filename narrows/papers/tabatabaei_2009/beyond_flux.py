"""Beyond the thesis: the current J(rho) of the colloids, from one in 100 a0 to close packing.

Two windows of time. Early, the colloids are a file on the mid-line. Late, dense channels have gone
over to a zigzag, which is slower.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.estimate import Estimate
from analysis.flux import asep_form, current
from analysis.line_fit import PolynomialFit, fit_polynomial
from analysis.settling import settling_series
from lammps_inputs import Scene
from lammps_inputs.scenes.poiseuille import Poiseuille
from narrows.papers.drawing import paper_line, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, claimed, compared, measured
from narrows.papers.tabatabaei_2009.many_colloids import REST_INTERCEPT, REST_SLOPE
from narrows.papers.tabatabaei_2009.state_points import Point, channel_point, scenes_of

NUMBER = "beyond-flux"
EARLY, LATE = (12.0, 300.0), (600.0, 1100.0)  # after the release [t0]
ZIGZAG = 0.018  # densities from here on leave the mid-line within the run [1/a0^2]
FRAME = 0.12  # V of the ASEP form that is drawn [a0/t0]


@cache
def short_channels(quality: Quality) -> tuple[Point, ...]:
    """100 x 10 from one colloid to 25, which touch."""
    if quality == "quick":
        return tuple(channel_point(100, number, 2, 200.0) for number in (4, 10, 16, 22, 25))
    return tuple(
        channel_point(100, number, 2) for number in (1, 2, 4, 7, 10, 13, 16, 18, 20, 22, 24, 25)
    )


@cache
def long_channels(quality: Quality) -> tuple[Point, ...]:
    """600 x 10 at densities of the short ones."""
    if quality == "quick":
        return tuple(channel_point(600, number, 1, 200.0) for number in (60, 96))
    return tuple(channel_point(600, number, 1, 500.0) for number in (24, 60, 96, 120, 144))


@cache
def pure_fluid(quality: Quality) -> Poiseuille:
    """The fluid of the channel without colloids, driven as a pressure gradient would."""
    return Poiseuille.make(
        length=100,
        width=10,
        collision_time=0.015,
        gravity=0.05,
        equilibration=30,
        duration=300.0 if quality == "full" else 100.0,
        sampling_interval=3.0,
    )


def scenes(quality: Quality) -> list[Scene]:
    """Every run that `homogeneous_law` needs."""
    return [*scenes_of(short_channels(quality)), pure_fluid(quality)]


@dataclass(frozen=True)
class Homogeneous:
    """Means of a homogeneous channel in a window of time.

    Attributes:
        rest, co_moving: mean velocity of the colloids in the two frames [a0/t0].
        frame: velocity of the co-moving frame, that of all mass together [a0/t0].
    """

    point: Point
    rest: Estimate
    co_moving: Estimate
    frame: Estimate

    @property
    def coupling(self) -> Estimate:
        """Volume flux per width and force per area X = frame / (rho F), as masses match volumes."""
        scene = self.point.scenes[0]
        return self.frame.scaled(1 / (self.point.density * scene.colloid_mass * scene.gravity))


def homogeneous(directories: Directories, point: Point, window: tuple[float, float]) -> Homogeneous:
    """Means over time and seeds; errors of all runs together."""
    runs = [settling_series(directories[scene]) for scene in point.scenes]
    used = [(run.times > window[0]) & (run.times <= window[1]) for run in runs]
    rest = [run.rest[part] for run, part in zip(runs, used, strict=True)]
    moving = [run.co_moving[part] for run, part in zip(runs, used, strict=True)]
    frame = [a - b for a, b in zip(rest, moving, strict=True)]
    return Homogeneous(point, *(correlated_mean.mean(series) for series in (rest, moving, frame)))


@dataclass(frozen=True)
class Constants:
    """Of a file on the mid-line.

    Attributes:
        intercept, slope: of v = c' + c rho in the frame at rest [a0/t0], [a0^3/t0].
        coupling: X, volume flux per width and force per area [a0^3/t0].
        permeability: K, that of the pure fluid [a0^3/t0].
    """

    intercept: float
    slope: float
    coupling: float
    permeability: float


@dataclass(frozen=True)
class Law:
    """What homogeneous channels tell of the file on the mid-line, with errors."""

    densities: tuple[float, ...]
    speed: PolynomialFit
    speed_errors: tuple[float, ...]
    coupling: PolynomialFit
    permeability: Estimate

    @property
    def constants(self) -> Constants:
        """Those of the fits."""
        intercept, slope = (entry.number for entry in self.speed.coefficients)
        coupling = self.coupling.coefficients[0].number
        return Constants(intercept, slope, coupling, self.permeability.number)

    def replica(self, rng: np.random.Generator) -> Constants:
        """Those of another measurement as good as this one."""
        scatter = max(1.0, self.speed.chi_squared / self.speed.freedom) ** 0.5
        errors = np.array(self.speed_errors)
        drawn = self.speed(self.densities) + scatter * errors * rng.normal(size=len(errors))
        again = [Estimate(float(v), float(e)) for v, e in zip(drawn, errors, strict=True)]
        intercept, slope = fit_polynomial(self.densities, again).coefficients
        coupling, permeability = (
            entry.number + rng.normal() * (entry.error or 0.0)
            for entry in (self.coupling.coefficients[0], self.permeability)
        )
        return Constants(intercept.number, slope.number, coupling, permeability)


def homogeneous_law(directories: Directories, quality: Quality) -> Law:
    """Fits through the short channels in the early window."""
    entries = [homogeneous(directories, point, EARLY) for point in short_channels(quality)]
    densities = _densities(entries)
    fluid = pure_fluid(quality)
    run = directories[fluid]
    table = run.table()
    flow = table["mean_velocity_x"][run.sampled(table.steps)]
    return Law(
        tuple(densities),
        fit_polynomial(densities, [entry.rest for entry in entries]),
        tuple(entry.rest.error or 0.0 for entry in entries),
        fit_polynomial(densities, [entry.coupling for entry in entries], degree=0),
        correlated_mean.mean(flow).scaled(1 / (fluid.density * fluid.gravity)),
    )


def _densities(entries: Sequence[Homogeneous]) -> list[float]:
    return [entry.point.density for entry in entries]


def _draw(
    early: Sequence[Homogeneous],
    long: Sequence[Homogeneous],
    late: Sequence[Homogeneous],
    line: PolynomialFit,
) -> Figure:
    figure = Figure(figsize=(10.5, 4.1), layout="constrained")
    speeds, currents = figure.subplots(1, 2)
    fine = np.linspace(0, 0.0265, 100)
    series = [(early, 0, "100 x 10, file on the mid-line"), (long, 1, "600 x 10, the same")]
    series += [(late, 2, "100 x 10, late: zigzag")] if late else []
    for entries, number, label in series:
        x = _densities(entries)
        hollow = {"markerfacecolor": "white"} if number == 2 else {}
        points(speeds, x, [entry.rest for entry in entries], number, label=label, **hollow)
        points(speeds, x, [entry.co_moving for entry in entries], number, alpha=0.55, **hollow)
        flow = [current(entry.point.density, entry.rest) for entry in entries]
        points(currents, x, flow, number, label=label, **hollow)
        flow = [current(entry.point.density, entry.co_moving) for entry in entries]
        points(currents, x, flow, number, alpha=0.55, **hollow)
    speeds.plot(fine, line(fine), label="line through the blue points, at rest")
    currents.plot(fine, fine * line(fine))
    thesis = REST_SLOPE.value * fine + REST_INTERCEPT.value
    paper_line(speeds, fine, thesis, r"thesis, Fig. 5.1: $5.71\,\rho + 0.019$, at rest")
    paper_line(currents, fine, fine * thesis, "thesis (5.3) at rest")
    form = asep_form(REST_SLOPE.value, REST_INTERCEPT.value, FRAME)
    label = rf"(5.3) from a frame at $V$ = {FRAME:g}: ASEP of negative $p - q$"
    paper_line(currents, fine, form.current(fine), label, linestyle=":")
    for axes, ylabel in (
        (speeds, "mean velocity  [$a_0/t_0$]"),
        (currents, r"current $J = \rho v$  [$1/(a_0 t_0)$]"),
    ):
        axes.axvline(0.025, color="0.7", linewidth=0.8)
        axes.set(xlabel=r"density $\rho = N_c/(L_x L_y)$  [$a_0^{-2}$]", ylabel=ylabel)
        axes.set_xlim(0, 0.0265)
        axes.legend(loc="upper left")
    speeds.set_ylim(0, 0.235)
    speeds.text(0.0247, 0.004, "file closed", rotation=90, ha="right", fontsize=8, color="0.5")
    speeds.text(0.0246, 0.082, "pale: co-moving", ha="right", fontsize=8.5, color="0.4")
    return figure


def _table(
    windows: Sequence[tuple[tuple[float, float], Sequence[Homogeneous]]],
) -> dict[str, Column]:
    rows = [(window, entry) for window, entries in windows for entry in entries]
    table: dict[str, Column] = {
        "from_t0": [window[0] for window, _ in rows],
        "to_t0": [window[1] for window, _ in rows],
        "length_a0": [entry.point.length for _, entry in rows],
        "colloids": [entry.point.colloids for _, entry in rows],
        "seeds": [len(entry.point.scenes) for _, entry in rows],
        "density_per_a0^2": [entry.point.density for _, entry in rows],
    }
    for name in ("rest", "co_moving", "frame", "coupling"):
        entries: list[Estimate] = [getattr(entry, name) for _, entry in rows]
        table[name] = [entry.value for entry in entries]
        table[f"{name}_error"] = [entry.error for entry in entries]
    return table


def _make(directories: Directories, quality: Quality) -> Outcome:
    early = [homogeneous(directories, point, EARLY) for point in short_channels(quality)]
    long = [homogeneous(directories, point, EARLY) for point in long_channels(quality)]
    late = list[Homogeneous]()
    if quality == "full":
        late = [homogeneous(directories, point, LATE) for point in short_channels(quality)]
    law = homogeneous_law(directories, quality)
    results = _early_results(law, early, long) + (_late_results(late) if late else [])
    table = _table([(EARLY, early), (EARLY, long), (LATE, late)])
    return Outcome(_draw(early, long, late, law.speed), table, results)


def _early_results(
    law: Law,
    early: Sequence[Homogeneous],
    long: Sequence[Homogeneous],
) -> list[Result]:
    intercept, slope = law.speed.coefficients
    everything = f"100 x 10, t from 12 to 300, rho up to 0.025; {law.speed.quality}"
    moving = fit_polynomial(_densities(early), [entry.co_moving for entry in early])
    parabola = fit_polynomial(_densities(early), [entry.rest for entry in early], degree=2)
    results = [
        compared(NUMBER, "c of v = c rho + c' at rest [a0^3/t0]", slope, REST_SLOPE, everything),
        compared(
            NUMBER, "c' of v = c rho + c' at rest [a0/t0]", intercept, REST_INTERCEPT, everything
        ),
        claimed(
            NUMBER,
            "coefficient of rho^2 of a parabola, at rest [a0^5/t0]",
            parabola.coefficients[2],
            "v is linear in rho, here up to close packing",
            "zero",
            parabola.quality,
        ),
        claimed(
            NUMBER,
            "d^2 J/d rho^2 = 2 c, the same in every frame [a0^3/t0]",
            slope.scaled(2.0),
            "J is convex: (5.3) with c > 0, an ASEP of negative p - q",
            "positive",
        ),
        measured(
            NUMBER,
            "slope of the co-moving v_s over rho [a0^3/t0]",
            moving.coefficients[1],
            moving.quality,
        ),
        measured(
            NUMBER,
            "flux of the fluid per force, X [a0^3/t0]",
            law.coupling.coefficients[0],
            f"one constant: {law.coupling.quality}",
        ),
        measured(NUMBER, "permeability of the pure fluid, K [a0^3/t0]", law.permeability),
    ]
    shorter = {entry.point.density: entry.rest for entry in early}
    gaps = [entry.rest - shorter[entry.point.density] for entry in long]
    level = fit_polynomial(_densities(long), gaps, degree=0)
    results.append(
        claimed(
            NUMBER,
            "v at rest in 600 x 10 less in 100 x 10, mean [a0/t0]",
            level.coefficients[0],
            "J(rho) is no effect of the length of the box",
            "zero",
            level.quality,
        )
    )
    return results


def _late_results(late: Sequence[Homogeneous]) -> list[Result]:
    line = fit_polynomial(_densities(late), [entry.rest for entry in late])
    dense = [entry for entry in late if entry.point.density >= ZIGZAG]
    bend = fit_polynomial(_densities(dense), [entry.rest for entry in dense])
    below = fit_polynomial(_densities(dense), [_below(entry) for entry in dense], degree=0)
    return [
        measured(
            NUMBER,
            "slope of v over rho at rest, t from 600 to 1100 [a0^3/t0]",
            line.coefficients[1],
            f"a line does not hold: {line.quality}",
        ),
        measured(
            NUMBER,
            f"the same for rho >= {ZIGZAG:g} only [a0^3/t0]",
            bend.coefficients[1],
            f"zigzag; {bend.quality}",
        ),
        claimed(
            NUMBER,
            "v of (5.3) less v at rho >= 0.018, t from 600 to 1100 [a0/t0]",
            below.coefficients[0],
            "v is linear in rho, here in the zigzag",
            "zero",
            "the zigzag is slower than the file: (5.3) ends where colloids leave the mid-line",
        ),
    ]


def _below(entry: Homogeneous) -> Estimate:
    thesis = REST_SLOPE.value * entry.point.density + REST_INTERCEPT.value
    return thesis - entry.rest


FIGURES = (
    PaperFigure(
        NUMBER,
        "Beyond the thesis: mean velocity and current of the colloids from dilute to a closed "
        "file, at rest and co-moving.",
        _make,
        lambda quality: [*scenes(quality), *scenes_of(long_channels(quality))],
    ),
)
