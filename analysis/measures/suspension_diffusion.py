"""Diffusion of colloids in all directions, and what it is without the images of the box."""

from matplotlib.figure import Figure

from analysis.estimate import Estimate
from analysis.findings import Findings, in_si
from analysis.health import SIGNIFICANT
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory
from analysis.suspension_diffusion import (
    TERMS,
    SuspensionDiffusion,
    infinite_box,
    suspension_diffusion,
)

MEMORY = 0.1  # of a velocity: with more, D of a persistent walk is short by a fifth or more

QUANTITIES = ("diffusion.msd", "diffusion.green_kubo", "diffusion.infinite_box")


def measure(run: RunDirectory) -> Findings:
    """D by the mean squared displacement, by Green and Kubo, and in an infinite box."""
    solvent, positions = run.solvent, run.particles().positions[sampled_frames(run)]
    longest = TERMS * solvent.collision_time
    try:
        found = suspension_diffusion(positions, run.interval, longest)
    except ValueError as error:
        none = Estimate(None, None, str(error)).as_json()
        return Findings({"diffusion": dict.fromkeys(("msd", "green_kubo", "infinite_box"), none)})
    if solvent.viscosity_theory is None:
        infinite = Estimate(None, None, "there are no hydrodynamics between images")
    elif not all(run.box.periodic):
        infinite = Estimate(None, None, "the correction is that of a periodic box")
    else:
        eta = solvent.density * solvent.viscosity_theory
        infinite = infinite_box(found.from_msd, eta, run.length)
    known = {"msd": found.from_msd, "green_kubo": found.green_kubo, "infinite_box": infinite}
    entry = {name: in_si(run, each, length=2, time=-1) for name, each in known.items()}
    return Findings(
        {"diffusion": entry},
        {"diffusion.png": draw(found)},
        warnings=correlation_warnings(found.kept, float(found.times[-1]), longest),
    )


def correlation_warnings(kept: Estimate, longest: float, wanted: float) -> tuple[str, ...]:
    """Where colloids keep their way for longer than D looks at them.

    It is then too small; too large if they are sheared.

    Args:
        kept: of a velocity at the longest lag.
        longest: lag [t0].
        wanted: lag, of a run that is long enough [t0].
    """
    if kept.number - SIGNIFICANT * kept.normal_error <= MEMORY:
        return ()
    return (
        f"at the longest lag of diffusion, {longest:.3g} t0, {kept.number:.2g} of a colloid's "
        "velocity is left: D is not that of long times"
        + ("; run longer" if longest < 0.9 * wanted else ""),
    )


def draw(
    found: SuspensionDiffusion,
    squares: str = "displacement in a direction [$a_0^2$]",
    unit: str = "a_0^2/t_0",
) -> Figure:
    """Mean squared displacement, and the sum of (35) by where it ends.

    Args:
        squares: what they are of.
        unit: of the diffusion coefficient.
    """
    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(found.times, found.msd, "o-", markersize=3)
    left.set_xlabel("lag [$t_0$]")
    left.set_ylabel(f"mean squared {squares}")
    right.plot(found.times, found.integral, "o-", markersize=3, label="(35) up to the lag")
    right.axhline(found.from_msd.value or 0.0, color="0.5", label="from the squares")
    right.set_xlabel("lag [$t_0$]")
    right.set_ylabel(f"diffusion coefficient [${unit}$]")
    right.legend()
    return figure
