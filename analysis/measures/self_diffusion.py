"""Self-diffusion along the periodic axes, of particles without a solvent."""

import numpy as np

from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory
from analysis.suspension_diffusion import suspension_diffusion

QUANTITIES = ("self_diffusion",)
LONGEST = 5.0  # lag: many times D, the time in which velocities are lost [t0]


def measure(run: RunDirectory) -> Findings:
    """D by the mean squared displacement over lags of 2.5 to 5."""
    free = np.flatnonzero(run.box.periodic)
    positions = run.particles().positions[sampled_frames(run)][:, :, free]
    try:
        found = suspension_diffusion(positions, run.interval, LONGEST).from_msd
    except ValueError as error:
        found = Estimate(None, None, str(error))
    return Findings({"self_diffusion": found.as_json()})
