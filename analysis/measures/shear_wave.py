"""Viscosity from the decay of a shear wave."""

import numpy as np
from matplotlib.figure import Figure

from analysis.arrays import Array
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory
from analysis.shear_wave import decay_viscosity, wave_amplitude

QUANTITIES = ("viscosity",)


def measure(run: RunDirectory) -> Findings:
    """The viscosity of the whole record after the equilibration, and the amplitude in time."""
    fluid = run.profile()
    used = run.sampled(fluid.steps)
    amplitude = wave_amplitude(fluid.y, run.width, fluid.counts, fluid.velocity_x)
    viscosity = decay_viscosity(amplitude[used], run.interval, run.looks, run.width)
    figure = draw(run.times(fluid.steps), amplitude, run.equilibration_time, viscosity, run.width)
    theory = {"theory": run.solvent.viscosity_theory}
    return Findings({"viscosity": viscosity.as_json() | theory}, {"shear_wave.png": figure})


def draw(
    times: Array, amplitude: Array, equilibration: float, viscosity: Estimate, width: float
) -> Figure:
    """Amplitude of the shear wave against time, with the fitted decay.

    Args:
        times: ends of the sampling intervals, (K,) [t0].
        amplitude: (K,) [a0/t0].
        equilibration: time the fit leaves out [t0].
        viscosity: of the fit [a0^2/t0].
        width: L_y, the wave length [a0].
    """
    figure, axes = one_panel(TIME, "amplitude of $\\sin(2\\pi y/L_y)$ [$a_0/t_0$]")
    axes.plot(times, amplitude, ".", markersize=3, label="each sampling interval")
    if viscosity.value is not None:
        used = times > equilibration
        decay = np.exp(-viscosity.value * (2 * np.pi / width) ** 2 * times[used])
        scale = amplitude[used] @ decay / (decay @ decay)
        label = f"$\\exp(-\\nu k^2 t)$, $\\nu$ = {viscosity.value:.4g}"
        axes.plot(times[used], scale * decay, label=label)
    axes.axhline(0, color="0.7", linewidth=0.8)
    mark_equilibration(axes, equilibration)
    axes.legend()
    return figure
