"""Fig. 3: the pair diffusivity D(r) in bulk."""

from lammps_inputs import Scene
from lammps_inputs.scenes.bulk_spheres import BulkSpheres
from narrows.papers.carmer_2012.pores import agreement, draw
from narrows.papers.carmer_2012.profiles import Profile, about_particles, by_colors, table_of
from narrows.papers.drawing import COLOURS, one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result

PACKINGS = (0.2, 0.35)
PROBABILITY = 0.01
FRAME = 0.2
LAGS, LAG = (2, 4, 8), 8  # in frames; longer ones lose the pairs that go too far
BINS = 24
CENTERS = 20
FARTHEST = 5.0  # of the likelihood: near it D is too low, for pairs that go beyond are lost
SHOWN = 4.0
FIT = 0.4


def colored(packing: float, quality: Quality) -> BulkSpheres:
    """The run whose colours react: in full the paper's N and R_cut."""
    full = quality == "full"
    return BulkSpheres.make(
        particles=4000 if full else 1000,
        cutoff=8.0 if full else 5.0,
        centers=40 if full else CENTERS,
        packing_fraction=packing,
        reaction_probabilities=(PROBABILITY, 0.1),
        duration=4000.0 if full else 400.0,
        equilibration=200.0,
    )


def followed(packing: float, quality: Quality) -> BulkSpheres:
    """The run whose paths are kept."""
    return BulkSpheres.make(
        particles=800,
        cutoff=SHOWN,
        centers=1,
        packing_fraction=packing,
        reaction_probabilities=(1.0,),
        trajectory=True,
        sampling_interval=FRAME,
        duration=40.0 if quality == "quick" else 200.0,
        equilibration=10.0,
        seed=2,
    )


def both(quality: Quality) -> list[Scene]:
    """The runs."""
    return [make(packing, quality) for make in (colored, followed) for packing in PACKINGS]


def comparison(directories: Directories, quality: Quality) -> Outcome:
    """Fig. 3, by the corrected (3)."""
    figure, axes = one_panel("distance $r$", "pair diffusivity $D(r)$")
    highest = 0.0
    shown = list[tuple[float, str, Profile]]()
    results: list[Result] = []
    for number, packing in enumerate(PACKINGS):
        colors = by_colors(directories[colored(packing, quality)])[PROBABILITY]
        run = directories[followed(packing, quality)]
        paths = about_particles(run, CENTERS, FARTHEST, BINS, LAGS, LAG)
        shown += [(packing, "colours", colors), (packing, "likelihood", paths)]
        draw(axes, colors, number, f"colours, packing {packing:g}")
        axes.plot(paths.place, paths.diffusivity, "o", color=COLOURS[number], markersize=4)
        highest = max(highest, float(paths.diffusivity.max()))
        results += agreement(
            "3",
            packing,
            (colors, paths),
            (("1.5 < r < 3.5", 1.5, 3.5), ("r < 1.2", 1.0, 1.2)),
            (FIT, (FARTHEST - 1) / BINS),
        )
    axes.plot([], [], "o", color="0.3", label="likelihood")
    axes.set(xlim=(1, SHOWN), ylim=(0, 2 * highest))
    axes.legend()
    return Outcome(figure, table_of(shown, "r"), results)


FIGURES = (
    PaperFigure(
        "3",
        "Pair diffusivity of bulk hard spheres: colours (p_r 0.01, (3) corrected, bands of 95 %), "
        "and likelihood (points).",
        comparison,
        both,
    ),
)
