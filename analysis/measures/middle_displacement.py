"""D across walls in the middle, by the mean squared displacement: a check of the profiles."""

from typing import Any

import numpy as np

from analysis.diffusivity import AlongAxis, DiffusivityError, MiddleDiffusivity
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("middle_displacement",)


def measure(run: RunDirectory) -> Findings:
    """D of displacements that begin in the middle third; nothing where all axes are periodic."""
    walled = np.flatnonzero(~np.asarray(run.box.periodic))
    if len(walled) == 0:
        return Findings()
    try:
        found = displacements(run, int(walled[0]))
    except DiffusivityError as error:
        return Findings({"middle_displacement": Estimate(None, None, str(error)).as_json()})
    entry = Estimate(found.diffusivity, found.error, freedom=found.freedom).as_json()
    return Findings({"middle_displacement": entry | {"window": list(found.window)}})


def displacements(run: RunDirectory, axis: int) -> Any:
    """The results of `MiddleDiffusivity` across the walls of an axis, between which centres move.

    Raises:
        DiffusivityError: when the run is too short, or its frames too far apart.
    """
    radius = run.species().radius
    coordinate = AlongAxis(run.universe().atoms, "xyz"[axis])
    analysis = MiddleDiffusivity(coordinate, radius, run.box.sizes[axis] - radius)
    return analysis.run(start=run.equilibration_frames).results
