"""Diffusion of the colloids along the channel, about their mean drift."""

import numpy as np
from matplotlib.figure import Figure

from analysis.diffusion import Diffusion, diffusion
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("diffusion", "diffusion.from_vacf", "diffusion.exponent")


def measure(run: RunDirectory) -> Findings:
    """D from the MSD and from the VACF, and the exponent of the MSD."""
    used, particles = sampled_frames(run), run.particles()
    try:
        result = diffusion(
            particles.positions[used][:, :, 0], particles.velocities[used][:, :, 0], run.interval
        )
    except ValueError as error:
        return Findings({"diffusion": {"value": None, "error": None, "reason": str(error)}})
    entry = {
        **result.from_msd.as_json(),
        "from_vacf": result.from_vacf.as_json(),
        "exponent": result.exponent.as_json(),
        "subdiffusive": result.subdiffusive,
        "window": list(result.window),
    }
    return Findings({"diffusion": entry}, {"diffusion.png": draw(result)})


def draw(result: Diffusion) -> Figure:
    """Mean squared displacement and velocity autocorrelation along x."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    lags = result.times > 0
    left.loglog(result.times[lags], result.msd[lags], "o", markersize=3, label="MSD")
    exponent, error = result.exponent.value, result.exponent.error
    if exponent is not None and error is not None:
        window = (result.times >= result.window[0]) & (result.times <= result.window[1])
        times, msd = result.times[window], result.msd[window]
        power = times**exponent
        scale = np.exp(np.mean(np.log(msd / power)))
        label = f"exponent {exponent:.3f} $\\pm$ {error:.3f}"
        left.loglog(times, scale * power, label=label)
    left.set_xlabel("lag [$t_0$]")
    left.set_ylabel("mean squared displacement along $x$ [$a_0^2$]")
    left.legend()
    right.plot(result.times, result.vacf / result.vacf[0], "o-", markersize=3, linewidth=0.8)
    right.axhline(0, color="0.7", linewidth=0.8)
    right.set_xlabel("lag [$t_0$]")
    right.set_ylabel("velocity autocorrelation along $x$ / its start")
    return figure
