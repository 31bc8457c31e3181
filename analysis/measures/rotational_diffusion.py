"""How the orientation of colloids diffuses."""

from scipy.integrate import cumulative_trapezoid

from analysis.estimate import Estimate
from analysis.findings import Findings, in_si
from analysis.measures.settling_speed import sampled_frames
from analysis.measures.suspension_diffusion import draw
from analysis.run_directory import RunDirectory
from analysis.suspension_diffusion import TERMS, suspension_diffusion
from run_files import RunDirectoryError

QUANTITIES = ("rotational_diffusion.msd", "rotational_diffusion.green_kubo")


def measure(run: RunDirectory) -> Findings:
    """D_r, as (34) to (36) have D of the centres, from the angle that the angular velocity sums to.

    Raises:
        RunDirectoryError: when the run keeps no angular velocities.
    """
    spins = run.particles().spins
    if spins is None:
        raise RunDirectoryError(f"{run.path}: its trajectory has no angular velocities")
    angles = cumulative_trapezoid(spins[sampled_frames(run)], dx=run.interval, axis=0, initial=0)
    try:
        found = suspension_diffusion(angles, run.interval, TERMS * run.solvent.collision_time)
    except ValueError as error:
        none = Estimate(None, None, str(error)).as_json()
        return Findings({"rotational_diffusion": dict.fromkeys(("msd", "green_kubo"), none)})
    known = {"msd": found.from_msd, "green_kubo": found.green_kubo}
    entry = {name: in_si(run, each, time=-1) for name, each in known.items()}
    figure = draw(found, "angle about an axis", "1/t_0")
    return Findings({"rotational_diffusion": entry}, {"rotational_diffusion.png": figure})
