"""D across walls in the middle, by the mean squared displacement: a check of the profiles."""

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
    axis, radius = int(walled[0]), run.species().radius
    first = -(-run.equilibration_steps // run.clock.sample_steps)
    coordinate = AlongAxis(run.universe().atoms, "xyz"[axis])
    try:
        analysis = MiddleDiffusivity(coordinate, radius, run.box.sizes[axis] - radius)
        found = analysis.run(start=first).results
    except DiffusivityError as error:
        return Findings({"middle_displacement": Estimate(None, None, str(error)).as_json()})
    entry = Estimate(found.diffusivity, found.error, freedom=found.freedom).as_json()
    return Findings({"middle_displacement": entry | {"window": list(found.window)}})
