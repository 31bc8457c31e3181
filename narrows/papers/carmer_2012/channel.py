"""Beyond the paper: D(y) of a colloid across our channel, with and without hydrodynamics.

The paper begins with hydrodynamic theory: in a viscous solvent the diffusivity of a particle near
an interface depends on its position. Here the solvent is the MPC fluid, and in its place a random
one (`bath`), which drags the colloid too but carries no momentum to the wall: what differs between
the two is the drag of the wall.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from analysis import RunDirectory
from analysis.arrays import Array
from analysis.diffusivity import BayesianDiffusivity, MiddleDiffusivity, Recorded
from analysis.estimate import Estimate, mean_of_independent
from analysis.measures.settling_speed import sampled_frames
from lammps_inputs import Scene
from lammps_inputs.scenes.channel import Channel
from narrows.papers.drawing import COLOURS, one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, claimed, measured

NUMBER = "beyond-channel"
LENGTH, WIDTH, RADIUS = 24.0, 8.0, 1.5
DENSITY, COLLISION_TIME, MD_STEPS = 5.0, 0.2, 50
FARTHEST = 2.7  # from the mid-line: centres come no nearer to a wall
BINS = 6
FRAME = 1.0
SOLVENTS = {"on": "MPC fluid", "bath": "random solvent"}
EQUILIBRATION = {"on": 200.0, "bath": 1000.0}
DURATION = {"quick": {"on": 4000.0, "bath": 12000.0}, "full": {"on": 8000.0, "bath": 16000.0}}
SEEDS = {"quick": 4, "full": 8}
LAGS = {"on": (16, 32), "bath": (64, 128)}  # in frames: of the result, and twice it
SHIFTS = 4
INNER = 2  # faces near the mid-line


def colloids(solvent: str, quality: Quality) -> list[Channel]:
    """The runs of one colloid without gravity; each tells D on its own."""
    return [
        Channel.make(
            length=LENGTH,
            width=WIDTH,
            density=DENSITY,
            collision_time=COLLISION_TIME,
            md_steps_per_collision=MD_STEPS,
            colloids=1,
            colloid_radius=RADIUS,
            wall_sigma=RADIUS,
            gravity=0.0,
            hydrodynamics=solvent,
            sampling_interval=FRAME,
            equilibration=EQUILIBRATION[solvent],
            duration=DURATION[quality][solvent],
            seed=seed,
        )
        for seed in range(1, SEEDS[quality] + 1)
    ]


def from_the_middle(runs: Sequence[RunDirectory]) -> Array:
    """Distance of the colloid from the mid-line, (T, runs): both sides are alike."""
    return np.stack([np.abs(across(run)) for run in runs], axis=1)


def across(run: RunDirectory) -> Array:
    """y of the colloid from the mid-line, (T,)."""
    positions = run.particles().positions[sampled_frames(run)]
    return np.asarray(positions[:, 0, 1] - run.box.sizes[1] / 2)


def profile(values: Array, lag: int) -> Array:
    """D at the faces of the bins by the likelihood of transitions, all runs together.

    Transitions of windows that do not overlap tell less than the paths do: harmonic mean of 4
    sets of windows, each a quarter of the lag after the other.
    """
    stride = lag // SHIFTS
    resistance = []
    for shift in range(SHIFTS):
        coordinate = Recorded(values[shift * stride :: stride], stride * FRAME)
        estimator = BayesianDiffusivity(
            coordinate, 0.0, FARTHEST, bins=BINS, lags=(SHIFTS,), samples=0
        )
        resistance.append(1 / estimator.run().results.diffusivity)
    return np.asarray(1 / np.mean(resistance, axis=0))


def of_runs(statistic: Callable[[Array], Array], values: Array) -> list[Estimate]:
    """Numbers from all runs together, (n,), with errors by the jackknife over runs."""
    count = values.shape[1]
    without = np.array([statistic(np.delete(values, run, axis=1)) for run in range(count)])
    errors = np.sqrt((count - 1) * without.var(axis=0))
    pairs = zip(statistic(values), errors, strict=True)
    return [Estimate(float(value), float(error), None, count - 1) for value, error in pairs]


def with_ratio(lag: int, values: Array) -> Array:
    """D at the faces, its harmonic mean over the first two, and the last over that."""
    d = profile(values, lag)
    middle = 1 / np.mean(1 / d[:INNER])
    return np.array([*d, middle, d[-1] / middle])


def comparison(directories: Directories, quality: Quality) -> Outcome:
    """D from the mid-line to the wall in both solvents."""
    figure, axes = one_panel("from the mid-line $|y|$ [$a_0$]", "diffusivity $D(y)$ [$a_0^2/t_0$]")
    faces = FARTHEST / BINS * np.arange(1, BINS)
    what = f"1 less D {faces[-1]:.2f} from the mid-line over D near it"
    rows: list[tuple[str | float, ...]] = []
    results: list[Result] = []
    slower: dict[str, Estimate] = {}
    for number, (solvent, label) in enumerate(SOLVENTS.items()):
        runs = [directories[scene] for scene in colloids(solvent, quality)]
        values = from_the_middle(runs)
        for lag, full in zip(LAGS[solvent], (True, False), strict=True):
            *d, middle, ratio = of_runs(partial(with_ratio, lag), values)
            rows += [
                (solvent, lag * FRAME, float(place), each.number, each.standard_error)
                for place, each in zip(faces, d, strict=True)
            ]
            axes.errorbar(
                faces,
                [each.number for each in d],
                [each.half_width() for each in d],
                fmt="os"[number],
                color=COLOURS[number],
                fillstyle="full" if full else "none",
                label=f"{label}, lag {lag * FRAME:g}",
            )
            told = f"{label}, lag {lag * FRAME:g}"
            results.append(measured(NUMBER, f"D near the mid-line, {told} [a0^2/t0]", middle))
            if full:
                slower[solvent] = 1 - ratio
            else:
                results.append(measured(NUMBER, f"{what}, {told}", 1 - ratio))
        told = f"D in the middle third by displacements, {label} [a0^2/t0]"
        results.append(measured(NUMBER, told, _displacements(runs)))
    results += [
        claimed(
            NUMBER,
            f"{what}, MPC fluid",
            slower["on"],
            "in a viscous solvent D of a particle near an interface depends on its position",
            "positive",
        ),
        measured(NUMBER, f"{what}, random solvent", slower["bath"]),
        claimed(
            NUMBER,
            "the one less the other: the drag of the wall",
            slower["on"] - slower["bath"],
            "so hydrodynamic theory predicts",
            "positive",
        ),
    ]
    axes.set(xlim=(0, FARTHEST), yscale="log")
    axes.legend(title="bars of 95 %")
    names = ("solvent", "lag", "from_middle", "diffusivity", "error")
    table = {name: [row[n] for row in rows] for n, name in enumerate(names)}
    return Outcome(figure, table, results)


def _displacements(runs: Sequence[RunDirectory]) -> Estimate:
    """The check by the mean squared displacement from the middle third: mean over runs."""
    found = []
    for run in runs:
        coordinate = Recorded(across(run)[:, None], run.interval)
        found.append(MiddleDiffusivity(coordinate, -FARTHEST, FARTHEST).run().results.diffusivity)
    return mean_of_independent(found)


def both(quality: Quality) -> list[Scene]:
    """All runs."""
    return [scene for solvent in SOLVENTS for scene in colloids(solvent, quality)]


FIGURES = (
    PaperFigure(
        NUMBER,
        "D(y) of one colloid in the channel, in the MPC fluid and in a random solvent, by "
        "likelihood.",
        comparison,
        both,
    ),
)
