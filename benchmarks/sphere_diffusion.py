"""Self-diffusion of hard spheres in bulk over box size, and of soft spheres in their place.

    python benchmarks/sphere_diffusion.py [--time 1] [--soft 300] [--page docs/diffusivity.md]

Bulk: D by the mean squared displacement (over a lag of 5, or of 12 D where that is more, and its
second half; D is the time in which velocities are lost) in cubes of 108 to 4000 hard spheres
(engine `events`, seed the number of spheres). Each is carried to an infinite box and lag by mode
coupling (`outstanding_diffusion`) with Enskog's viscosity; if that is right the four agree. Beside
their mean: Enskog's theory, and the fits of R. J. Speedy, Mol. Phys. 62, 509 (1987), and of E.
Ruckenstein and H. Liu, Ind. Eng. Chem. Res. 36, 3927 (1997), the latter to infinite systems. --time
multiplies all runs.

Soft: the scene `bulk_spheres` with 500 hard spheres by `events`, and pseudo hard and WCA spheres by
`md`, for --soft time units after 20, D by lags of 2.5 to 5; 0 leaves it out.

With --page the tables go between the marks `bulk` and `soft` of that page.
"""

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

from analysis import analyze
from analysis.estimate import Estimate
from analysis.suspension_diffusion import outstanding_diffusion, suspension_diffusion
from lammps_inputs.scenes.bulk_spheres import BulkSpheres
from narrows.markdown import replace_block, table
from srd_driver import Simulation
from srd_driver.events import HardSpheres

PACKINGS = (0.1, 0.2, 0.35)
SIZES = (108, 256, 864, 4000)
SPHERE_TIME = 500_000.0  # spheres times time units of each run, by default
FRAME, LONGEST = 0.5, 5.0
SEGMENTS, QUARTER = 8, 4  # of a run, and of a segment: the longest lag
KINDS = ("hard", "pseudo_hard", "wca")


def speedy(density: float) -> float:
    """D of the fit, from the ideal gas to the metastable fluid."""
    ideal = 3 / 8 / math.sqrt(math.pi) / density
    excess = density * density * (0.4 - 0.83 * density * density)
    return ideal * (1 - density / 1.09) * (1 + excess)


def ruckenstein(packing: float) -> float:
    """D of the fit to B. Alder et al. (1970) and J. Erpenbeck and W. Wood (1991), infinite systems.

    Over Enskog's D, with a factor of 1.019 or without: the coefficients are quoted from memory.
    """
    x = 6 * packing / math.pi
    excess = 0.94605 * x**1.5 + 1.4022 * x**3 - 5.6898 * x**5 + 2.6626 * x**7
    return float(enskog(packing)[0] * (1 + excess))


def contact(packing: float) -> float:
    """g at contact, of Carnahan and Starling."""
    return (1 - packing / 2) / (1 - packing) ** 3


def enskog(packing: float) -> tuple[float, float]:
    """D and viscosity of Enskog's theory (S. Chapman, T. Cowling, 16.5 and 16.41)."""
    density, g = 6 * packing / math.pi, contact(packing)
    d = 1.01896 * 3 / 8 / math.sqrt(math.pi) / (density * g)
    b = 4 * packing * g  # b rho chi
    gas = 1.01600 * 5 / 16 / math.sqrt(math.pi)
    return d, gas * 4 * packing * (1 / b + 0.8 + 0.7614 * b)


def diffusivity(count: int, packing: float, scale: float) -> tuple[Estimate, Estimate]:
    """D of so many spheres, and of infinitely many."""
    edge = (count * math.pi / 6 / packing) ** (1 / 3)
    engine = HardSpheres.fluid(count, 3 * [edge], seed=count)
    theory, viscosity = enskog(packing)
    longest = max(LONGEST, 12 * theory)
    engine.advance(30)
    frames = []
    time = max(SEGMENTS * QUARTER * longest, scale * SPHERE_TIME / count)
    for _ in range(math.ceil(time / FRAME)):
        engine.advance(FRAME)
        frames.append(engine.positions + engine.images * engine.lengths)
    found = suspension_diffusion(np.array(frames), FRAME, longest)
    late = found.times[found.times >= 0.5 * found.times[-1]]
    d = found.from_msd
    return d, d + outstanding_diffusion(d.number, viscosity, 6 * packing / math.pi, edge, late)


def weighted(values: list[Estimate]) -> tuple[Estimate, float]:
    """Mean, and chi^2 of what it is the mean of."""
    d = np.array([each.number for each in values])
    weight = np.array([each.standard_error for each in values]) ** -2.0
    mean = float(np.sum(weight * d) / weight.sum())
    return Estimate(mean, float(weight.sum() ** -0.5)), float(np.sum(weight * (d - mean) ** 2))


def shown(value: Estimate, digits: int = 4) -> str:
    return f"{value.number:.{digits}f} +- {value.standard_error:.{digits}f}"


def bulk(scale: float) -> str:
    rows = []
    for packing in PACKINGS:
        points = [diffusivity(count, packing, scale) for count in SIZES]
        infinite, chi2 = weighted([each for _, each in points])
        fits = (enskog(packing)[0], ruckenstein(packing), speedy(6 * packing / math.pi))
        rows.append(
            (
                f"{packing:g}",
                *(f"{shown(d)} -> {each.number:.4f}" for d, each in points),
                f"{shown(infinite)} ({chi2:.1f})",
                *(f"{fit:.4f} ({infinite.number / fit - 1:+.1%})" for fit in fits),
            )
        )
    columns = (
        *("packing", *(f"N {count} -> infinite" for count in SIZES)),
        *("mean (chi^2 of 3)", "Enskog", "Ruckenstein, Liu", "Speedy"),
    )
    return table(columns, rows)


def soft(duration: float) -> str:
    rows = []
    reference: Estimate | None = None
    for kind in KINDS:
        scene = BulkSpheres.make(
            particles=500,
            centers=1,
            cutoff=4.0,
            spheres=kind,
            trajectory=True,
            sampling_interval=FRAME / 2,
            equilibration=20.0,
            duration=duration,
        )
        with tempfile.TemporaryDirectory() as folder:
            with Simulation(scene, directory=Path(folder) / "run") as simulation:
                engine = simulation.engine
                simulation.finish()
            summary = analyze(Path(folder) / "run")
        d = Estimate(summary["self_diffusion"]["value"], summary["self_diffusion"]["error"])
        reference = reference or d
        ratio = d.number / reference.number
        error = ratio * math.hypot(
            d.standard_error / d.number, reference.standard_error / reference.number
        )
        if "compressibility" in summary:
            z = summary["compressibility"]["value"]
        else:
            z = 1 + summary["pressure"]["value"] * math.pi / 6 / scene.packing_fraction
        excess = "" if d is reference else f"{ratio - 1:+.1%} +- {error:.1%}"
        rows.append((kind, engine, shown(d), excess, f"{z:.3f}"))
    return table(("spheres", "engine", "D", "over hard spheres'", "P V / (N kBT)"), rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--time", type=float, default=1.0)
    parser.add_argument("--soft", type=float, default=300.0)
    parser.add_argument("--page", type=Path)
    arguments = parser.parse_args()
    tables = {"bulk": bulk(arguments.time)} if arguments.time else {}
    if arguments.soft:
        tables["soft"] = soft(arguments.soft)
    for mark, text in tables.items():
        print(text)
        if arguments.page:
            replace_block(arguments.page, mark, text)


if __name__ == "__main__":
    main()
