"""Current and mobility of driven species whose velocities a solvent kicks between outputs."""

import numpy as np

from analysis import correlated_mean
from analysis.current import displacement_current, mobility
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.measures.soft_averages import field_of
from analysis.run_directory import RunDirectory

QUANTITIES = ("current", "mobility")


def measure(run: RunDirectory) -> Findings:
    """Means over time, by displacements: velocities just after a collision are the lowest."""
    used, particles = sampled_frames(run), run.particles()
    drives = run.manifest.system.drives
    signs = {drive.target: float(np.sign(drive.direction[0])) for drive in drives}
    series = displacement_current(
        particles.positions[used][:, :, 0],
        [signs.get(str(name), 0.0) for name in particles.species],
        run.times(particles.steps[used]),
    )
    entries = {"current": correlated_mean.mean(series).as_json()}
    field = field_of(run)
    if field:
        entries["mobility"] = mobility(series, field).as_json()
    return Findings(entries)
