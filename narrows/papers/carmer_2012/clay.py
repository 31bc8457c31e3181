"""Beyond the paper: D(z) of a tracer in a claylike suspension between walls (hecht-2005).

Any colloid is a tracer: colours are passive. What a suspension does to it is told by the same
colloids alone, and by what they do to each other: they only repel, or attract as clay does.
"""

from analysis import RunDirectory
from analysis.diffusivity import AlongAxis, ColorDiffusivity
from analysis.estimate import Estimate
from analysis.measures.middle_displacement import displacements
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.carmer_2012.pores import draw
from narrows.papers.carmer_2012.profiles import Profile, table_of
from narrows.papers.drawing import one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, claimed, measured

NUMBER = "beyond-clay"
FRACTIONS = (0.04, 0.1, 0.16)
REPELLING, ATTRACTING = "hertz", "dlvo"
CELLS = 12
SURFACE = 1.6  # of reaction, from either wall: centres keep 0.6 off
PROBABILITY = 0.3
REACH = 1.0  # of the local fit
INNER = 2.0  # from the middle: far from walls


def suspension(fraction: float, potential: str, quality: Quality) -> Claylike:
    """Colloids between walls across z, without gravity."""
    repelling = potential == REPELLING
    duration = (2000.0, 6000.0) if repelling else (200.0, 800.0)
    return Claylike.make(
        cells=CELLS,
        density=10,
        volume_fraction=fraction,
        potential=potential,
        lubrication="off",
        boundaries="bottom",
        md_steps_per_collision=20 if repelling else 140,
        sampling_interval=2.0,
        equilibration=200.0,
        duration=duration[quality == "full"],
    )


def scenes(quality: Quality) -> list[Scene]:
    """All runs."""
    repelling: list[Scene] = [suspension(each, REPELLING, quality) for each in FRACTIONS]
    return [*repelling, suspension(FRACTIONS[-1], ATTRACTING, quality)]


def by_displacements(run: RunDirectory) -> Estimate:
    """D across the walls of tracers in the middle third, by their mean squared displacement."""
    found = displacements(run, axis=2)
    return Estimate(found.diffusivity, found.error, None, found.freedom)


def by_colors(run: RunDirectory) -> Profile:
    """D(z) by colours laid on the paths, z from the middle."""
    height = run.box.sizes[2]
    across = AlongAxis(run.universe().atoms, "z")
    estimator = ColorDiffusivity(
        across, SURFACE, height - SURFACE, probability=PROBABILITY, reach=REACH
    )
    found = estimator.run(start=run.equilibration_frames).results
    return Profile(found.positions - height / 2, found.diffusivity, found.error)


def comparison(directories: Directories, quality: Quality) -> Outcome:
    """D(z) of tracers by volume fraction, and what attraction does to them."""
    figure, axes = one_panel("from the middle $z$  [$a_0$]", "diffusivity $D(z)$  [$a_0^2/t_0$]")
    shown = list[tuple[float, str, Profile]]()
    results: list[Result] = []
    middles: list[Estimate] = []
    for number, fraction in enumerate(FRACTIONS):
        run = directories[suspension(fraction, REPELLING, quality)]
        colors, middle = by_colors(run), by_displacements(run)
        middles.append(middle)
        shown.append((fraction, "colours", colors))
        draw(axes, colors, number, rf"repelling, $\phi$ = {fraction:g}")
        both = colors.mean(0.0, INNER, REACH) / middle - 1
        quantity = f"D by colours over D by displacements, less 1, middle, phi {fraction:g}"
        results += [
            measured(NUMBER, f"D of a tracer by displacements, middle, phi {fraction:g}", middle),
            claimed(NUMBER, quantity, both, "colours are passive: any trajectory will do", "zero"),
        ]
    attracted = by_displacements(directories[suspension(FRACTIONS[-1], ATTRACTING, quality)])
    axes.axhline(attracted.number, color="0.3", linestyle="--", label="attracting, displacements")
    low, high = FRACTIONS[0], FRACTIONS[-1]
    results += [
        measured(NUMBER, f"D at phi {high:g} over that at {low:g}", middles[-1] / middles[0]),
        measured(NUMBER, f"the same, clay attracting at phi {high:g}", attracted / middles[0]),
    ]
    axes.set(ylim=(0, 1.6 * middles[0].number))
    axes.legend(ncols=2)
    return Outcome(figure, table_of(shown, "z"), results)


FIGURES = (
    PaperFigure(
        NUMBER,
        "D(z) of a tracer in a claylike suspension between walls, by colours (bands of 95 %).",
        comparison,
        scenes,
    ),
)
