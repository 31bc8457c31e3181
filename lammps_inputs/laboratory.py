"""The table of a suspension and its simulation (hecht-2005, Tables I to IV)."""

import math

from lammps_inputs.comparison import WATER_MOLECULE, WATER_SELF_DIFFUSION, WATER_SOUND, Row
from lammps_inputs.material import Model, TimeScales


def time_rows(real: TimeScales, simulated: TimeScales) -> tuple[Row, ...]:
    """The times of section VI of hecht-2005, both in seconds."""
    names = (
        ("settling", "tau_S", "to settle by a diameter (17)"),
        ("diffusion", "tau_D", "to diffuse by a diameter (20)"),
        ("gap", "tau_G", "to diffuse across a gap of R / 2"),
        ("interaction", "tau_V", "oscillation in the primary minimum (26)"),
        ("fluid", "tau_F", "momentum in the fluid, by a diameter (24)"),
        ("particle", "tau_P", "relaxation of a velocity (23)"),
    )
    return tuple(
        Row(text, symbol, "s", getattr(real, name), getattr(simulated, name))
        for name, symbol, text in names
    )


def suspension_rows(model: Model) -> tuple[Row, ...]:
    """The whole table of a 3D suspension (hecht-2005, Tables I to IV)."""
    real, times = model.suspension, model.suspension.time_scales()
    simulated = model.time_scales()
    return (
        Row("radius", "R", "m", real.radius, real.radius),
        Row("temperature", "T", "K", real.temperature, model.temperature),
        Row("kinematic viscosity", "nu", "m^2/s", real.viscosity, model.viscosity),
        Row("gravity less buoyancy", "g", "m/s^2", _weight(model), model.gravity),
        Row("Hamaker constant", "A_H", "J", real.hamaker, real.hamaker / model.energy_scale),
        Row(
            "Hamaker constant over kBT",
            "A_H / kBT",
            "",
            real.hamaker / real.thermal_energy,
            real.hamaker / model.energy_scale / model.thermal_energy,
        ),
        Row("Stokes velocity (16)", "v_S", "m/s", real.stokes_velocity, real.stokes_velocity),
        Row(
            "diffusion coefficient (18)",
            "D",
            "m^2/s",
            real.diffusion_coefficient,
            model.thermal_energy
            / (6 * math.pi * model.viscosity * real.fluid_density * real.radius),
        ),
        *time_rows(times, simulated),
        Row("Peclet number (21)", "Pe", "", times.peclet, simulated.peclet),
        Row("Reynolds number (25)", "Re", "", times.reynolds, simulated.reynolds),
        Row("Schmidt number", "Sc", "", real.viscosity / WATER_SELF_DIFFUSION, model.schmidt),
        Row("Mach number", "Ma", "", real.stokes_velocity / WATER_SOUND, model.mach),
        Row("Knudsen number", "Kn", "", WATER_MOLECULE / real.radius, model.knudsen),
        Row(
            "tau_V over tau_P, creeping above 4 pi (27)",
            "tau_V / tau_P",
            "",
            times.interaction / times.particle,
            simulated.interaction / simulated.particle,
        ),
    )


def _weight(model: Model) -> float:
    s = model.suspension
    return s.gravity * (1 - s.fluid_density / s.particle_density)
