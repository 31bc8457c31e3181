"""Diffusivity profile across walls from the paths of particles, by colours and by likelihood."""

import numpy as np

from analysis.diffusivity import DiffusivityError
from analysis.diffusivity.trajectory import Estimated, drawing, estimate_all
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

ESTIMATORS = ("color", "bayes")


def measure(run: RunDirectory) -> Findings:
    """Profiles, and means over the middle third; nothing where all axes are periodic."""
    walled = np.flatnonzero(~np.asarray(run.box.periodic))
    if len(walled) == 0:
        return Findings()
    axis = "xyz"[walled[0]]
    try:
        found, missing = estimate_all(
            run.universe().atoms, axis, estimators=ESTIMATORS, start=run.equilibration_frames
        )
    except DiffusivityError as error:
        return Findings({"path_diffusivity": None}, warnings=(str(error),))
    middle = run.box.sizes[walled[0]] / 2
    rows = [
        (each.estimator, place - middle, d, error)
        for each in found
        for place, d, error in zip(each.positions, each.diffusivity, each.error, strict=True)
    ]
    names = ("estimator", axis, "diffusivity", "error")
    return Findings(
        {"path_diffusivity": {each.estimator: _middle(each) for each in found}},
        {"path_diffusivity.png": drawing(found, axis)},
        {"path_diffusivity.csv": {name: [row[n] for row in rows] for n, name in enumerate(names)}},
        tuple(missing),
    )


def _middle(profile: Estimated) -> dict[str, float]:
    """Harmonic mean over the middle third, and the typical error of one of its values."""
    low, high = profile.positions[[0, -1]]
    inner = np.abs(profile.positions - (low + high) / 2) < (high - low) / 6
    return {
        "middle": float(1 / np.mean(1 / profile.diffusivity[inner])),
        "error_of_a_value": float(np.median(profile.error[inner])),
    }
