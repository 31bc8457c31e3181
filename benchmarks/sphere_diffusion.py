"""Self-diffusion of hard spheres in bulk over box size, and of soft spheres in their place.

    python benchmarks/sphere_diffusion.py [--time 1] [--soft 300] [--page docs/diffusivity.md]

Bulk: D by the mean squared displacement (over a lag of 5, or of 12 D where that is more, and its
second half; D is the time in which velocities are lost) in cubes of 108 to 4000 hard
spheres (engine `events`, seed the number of spheres), extrapolated linearly in 1/L, beside the fit
of R. J. Speedy, Mol. Phys. 62, 509 (1987), and Enskog's theory; the slope beside that of Yeh and
Hummer, J. Phys. Chem. B 108, 15873 (2004), with Enskog's viscosity. --time multiplies all runs.

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
from analysis.suspension_diffusion import CUBIC, suspension_diffusion
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
    """D of the fit, good to a percent from the ideal gas to the metastable fluid."""
    ideal = 3 / 8 / math.sqrt(math.pi) / density
    return ideal * (1 - density / 1.09) * (1 + density**2 * (0.4 - 0.83 * density**2))


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


def diffusivity(count: int, packing: float, scale: float) -> tuple[float, Estimate]:
    """1/L and D of so many spheres."""
    edge = (count * math.pi / 6 / packing) ** (1 / 3)
    engine = HardSpheres.fluid(count, 3 * [edge], seed=count)
    longest = max(LONGEST, 12 * enskog(packing)[0])
    engine.advance(30)
    frames = []
    time = max(SEGMENTS * QUARTER * longest, scale * SPHERE_TIME / count)
    for _ in range(math.ceil(time / FRAME)):
        engine.advance(FRAME)
        frames.append(engine.positions + engine.images * engine.lengths)
    return 1 / edge, suspension_diffusion(np.array(frames), FRAME, longest).from_msd


def extrapolated(inverse: list[float], values: list[Estimate]) -> tuple[Estimate, Estimate, float]:
    """Intercept and slope of the weighted line through D over 1/L, and its chi^2."""
    d = np.array([each.number for each in values])
    error = np.array([each.standard_error for each in values])
    matrix = np.column_stack([np.ones(len(d)), inverse]) / error[:, None]
    covariance = np.linalg.inv(matrix.T @ matrix)
    fit = covariance @ matrix.T @ (d / error)
    chi2 = float(np.sum((matrix @ fit - d / error) ** 2))
    a, b = (
        Estimate(float(v), float(np.sqrt(c))) for v, c in zip(fit, np.diag(covariance), strict=True)
    )
    return a, b, chi2


def shown(value: Estimate, digits: int = 4) -> str:
    return f"{value.number:.{digits}f} +- {value.standard_error:.{digits}f}"


def bulk(scale: float) -> str:
    rows = []
    for packing in PACKINGS:
        points = [diffusivity(count, packing, scale) for count in SIZES]
        inverse, values = [x for x, _ in points], [d for _, d in points]
        infinite, slope, chi2 = extrapolated(inverse, values)
        theory, viscosity = enskog(packing)
        expected = -CUBIC / (6 * math.pi * viscosity)
        fit = speedy(6 * packing / math.pi)
        rows.append(
            (
                f"{packing:g}",
                *(shown(value) for value in values),
                f"{shown(infinite)} ({chi2:.1f})",
                f"{fit:.4f} ({infinite.number / fit - 1:+.1%})",
                f"{infinite.number / theory:.3f}",
                f"{shown(slope, 3)} ({expected:.3f})",
            )
        )
    columns = (
        *("packing", *(f"N {count}" for count in SIZES)),
        *("infinite (chi^2 of 2)", "Speedy's fit", "over Enskog's", "slope (Yeh, Hummer)"),
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
