"""How the orientation of colloids diffuses."""

import math

from scipy.integrate import cumulative_trapezoid

from analysis.estimate import Estimate
from analysis.findings import Findings, in_si
from analysis.measures.settling_speed import sampled_frames
from analysis.measures.suspension_diffusion import draw
from analysis.run_directory import RunDirectory
from analysis.suspension_diffusion import suspension_diffusion
from run_files import RunDirectoryError

QUANTITIES = ("rotational_diffusion.msd", "rotational_diffusion.green_kubo")

FORGOTTEN = 5  # relaxation times of the angular velocity


def measure(run: RunDirectory) -> Findings:
    """D_r, as (34) to (36) have D of the centres, from the angle that the angular velocity sums to.

    Lags are up to the time in which a sphere forgets how it spun, by free-molecular friction and
    the flow's together.

    Raises:
        RunDirectoryError: when the run keeps no angular velocities.
    """
    spins = run.particles().spins
    if spins is None:
        raise RunDirectoryError(f"{run.path}: its trajectory has no angular velocities")
    species, solvent = run.species(), run.solvent
    mobility = 1 / (4 / 3 * math.sqrt(2 * math.pi) * solvent.density * species.radius**4)
    if solvent.viscosity_theory:
        eta = solvent.density * solvent.viscosity_theory
        mobility += 1 / (8 * math.pi * eta * species.radius**3)
    longest = FORGOTTEN * species.inertia * mobility
    angles = cumulative_trapezoid(spins[sampled_frames(run)], dx=run.interval, axis=0, initial=0)
    try:
        found = suspension_diffusion(angles, run.interval, longest)
    except ValueError as error:
        none = Estimate(None, None, str(error)).as_json()
        return Findings({"rotational_diffusion": dict.fromkeys(("msd", "green_kubo"), none)})
    known = {"msd": found.from_msd, "green_kubo": found.green_kubo}
    entry = {name: in_si(run, each, time=-1) for name, each in known.items()}
    figure = draw(found, "angle about an axis", "1/t_0")
    return Findings({"rotational_diffusion": entry}, {"rotational_diffusion.png": figure})
