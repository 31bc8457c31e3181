"""How unevenly particles are spread, by numbers in boxes and the longest waves."""

import numpy as np

from analysis import correlated_mean
from analysis.density_fluctuations import number_variance, structure_factor
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("number_variance", "structure_factor")

BOXES = 4  # along each direction


def measure(run: RunDirectory) -> Findings:
    """Means over time."""
    frames = run.particles().positions[sampled_frames(run)][:, np.newaxis]
    sizes = run.box.sizes
    variance = [number_variance(frame, sizes, BOXES) for frame in frames]
    longest = [float(structure_factor(frame, sizes, 1)[1].mean()) for frame in frames]
    return Findings(
        {
            "number_variance": correlated_mean.mean(variance).as_json(),
            "structure_factor": correlated_mean.mean(longest).as_json(),
        }
    )
