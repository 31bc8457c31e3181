"""Flow that gravity drives through a slit: a parabola, which tells the viscosity."""

from analysis import correlated_mean, flow
from analysis.correlated_mean import ratio
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.measures.slit_flow import slit_flow
from analysis.run_directory import RunDirectory
from run_files import RunDirectoryError

QUANTITIES = (
    "maximum_velocity",
    "viscosity",
    "viscosity_curvature",
    "wall_slip",
    "fluid_velocity",
    "reynolds_number",
)


def measure(run: RunDirectory) -> Findings:
    """Maximum, viscosity by (3.15) of tabatabaei-2009 and by the curvature, wall slip.

    Raises:
        RunDirectoryError: when fewer than three bins hold fluid.
    """
    fluid = run.profile()
    used = run.sampled(fluid.steps)
    gravity = float(run.acceleration("fluid")[0])
    try:
        v_max, v_wall = flow.fit_parabola(
            fluid.y, run.width, fluid.counts[used], fluid.velocity_x[used]
        )
    except ValueError as error:
        raise RunDirectoryError(f"{run.path / 'fluid_profile.dat'}: {error}") from None
    maximum = correlated_mean.mean(v_max, run.interval)
    viscosity = viscosity_of_maximum(maximum, gravity, run.width)
    above_wall = correlated_mean.mean(v_max - v_wall, run.interval)
    curvature = viscosity_of_maximum(above_wall, gravity, run.width)
    theory = {"theory": run.solvent.viscosity_theory}
    flow_found = slit_flow(run, fit=(float(v_max.mean()), float(v_wall.mean())))
    entries = {
        "maximum_velocity": maximum.as_json(),
        "viscosity": viscosity.as_json() | theory,
        "viscosity_curvature": curvature.as_json(),
        "wall_slip": ratio(v_wall, v_max).scaled(100).as_json(),
    }
    return Findings(entries | dict(flow_found.entries), flow_found.figures)


def viscosity_of_maximum(maximum: Estimate, gravity: float, width: float) -> Estimate:
    """nu = g L_y^2 / (8 v_max), tabatabaei-2009 (3.15), with the error of v_max carried over.

    With v_max counted from the velocity at the walls it is nu = -g / v_x'', right with slip too.
    """
    if gravity == 0:
        return Estimate(None, None, "no gravity")
    if maximum.value is None or maximum.value * gravity <= 0:
        return Estimate(None, None, "the fluid does not flow along gravity")
    return gravity * width**2 / 8 / maximum
