"""Tables I to IV of hecht-2005, and every number of its section VII, to the printed digits."""

import math

import pytest

from lammps_inputs.material import Model, Suspension, coulomb_strength
from lammps_inputs.quantities import si

ALUMINA = Suspension()
REFLECTING = Model.reflecting(ALUMINA)
IN_COLLISION = Model.in_collision(ALUMINA, cell=6.25e-7)


def printed(value: float, text: str) -> None:
    """Within a unit of the last printed digit: the paper rounds some numbers, and cuts others."""
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    assert abs(value - float(text)) <= 10.0 ** (int(exponent or 0) - decimals), value


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("settling", "0.791"),
        ("diffusion", "0.582"),
        ("gap", "36.5e-3"),
        ("interaction", "7.45e-6"),
        ("fluid", "0.320e-6"),
        ("particle", "0.139e-6"),
    ],
)
def test_table_2(name: str, text: str) -> None:
    printed(getattr(ALUMINA.time_scales(), name), text)


def test_characteristic_numbers() -> None:
    times = ALUMINA.time_scales()
    printed(times.peclet, "0.74")
    printed(times.reynolds, "4.0e-7")
    printed(ALUMINA.diffusion_coefficient, "5.49e-13")
    assert times.interaction / times.particle == pytest.approx(7.45 / 0.139, rel=3e-3)
    assert times.creeping
    fourth = Suspension(radius=0.8e-6).time_scales().peclet / times.peclet
    assert fourth == pytest.approx(16)  # (21)


def test_coupling_1() -> None:
    printed(REFLECTING.viscosity_factor, "0.3052")
    printed(REFLECTING.collision_time, "0.91e-3")
    printed(REFLECTING.viscosity, "1.34e-11")
    # the paper goes on with its rounded 0.91 ms
    rounding = 0.91e-3 / REFLECTING.collision_time
    printed(REFLECTING.gravity / rounding, "9.78e-5")
    printed(REFLECTING.energy_scale * rounding**2, "7.44e4")
    printed(ALUMINA.hamaker / (REFLECTING.energy_scale * rounding**2), "6.39e-25")
    times = REFLECTING.time_scales()
    printed(times.interaction, "2.03e-3")
    printed(times.particle, "10.36e-3")
    printed(times.fluid, "23.9e-3")  # Table III has 22.9, which is not 2 R^2 / nu
    printed(times.reynolds, "3.0e-2")
    printed(times.interaction / times.particle, "0.196")
    assert not times.creeping
    assert times.settling / REFLECTING.collision_time == pytest.approx(869, rel=2e-3)
    assert times.lost_order() == []


def test_momentum_diffuses_by_24_cells_in_the_time_of_a_gap() -> None:
    """VII B has "during tau_D" 2 nu tau_G = 24.43 a^2: the number is that of tau_G."""
    squares = 2 * REFLECTING.viscosity * REFLECTING.time_scales().gap / REFLECTING.cell**2
    assert squares == pytest.approx(24.43, rel=3e-3)
    times = REFLECTING.time_scales()
    assert times.particle / REFLECTING.collision_time == pytest.approx(11.4, rel=5e-3)
    assert times.gap / times.particle == pytest.approx(3.5, rel=1e-2)  # "3.5 SRD steps"


def test_coupling_2() -> None:
    printed(IN_COLLISION.collision_time, "2.05e-3")
    # the paper goes on with its rounded 2.05 ms, and with 0.12 for the factor 0.1203 of (29)
    rounded = IN_COLLISION.viscosity * IN_COLLISION.collision_time / 2.05e-3
    rounded *= 0.12 / IN_COLLISION.viscosity_factor
    printed(rounded, "2.29e-11")
    scale = ALUMINA.gravity / IN_COLLISION.gravity * IN_COLLISION.viscosity / rounded
    printed(scale, "58813")
    time = 2.05e-3 / IN_COLLISION.collision_time
    assert IN_COLLISION.energy_scale * time**2 == pytest.approx(43733, rel=2e-3)
    times = IN_COLLISION.time_scales()
    printed(times.interaction, "1.56e-3")
    printed(times.fluid, "14.0e-3")
    printed(times.particle, "6.02e-3")
    printed(times.reynolds * IN_COLLISION.viscosity / rounded, "1.77e-2")
    printed(times.settling / 2.05e-3, "385")
    assert times.particle < times.fluid < times.gap < times.diffusion < times.settling


def test_the_cell_of_the_volume_of_a_particle_is_larger_than_printed() -> None:
    printed(Model.in_collision(ALUMINA).cell, "6.45e-7")


def test_production_runs() -> None:
    """m_f of Fig. 2 and 2e5 fluid particles are those of R = 0.25 um, a = 0.4 um, 15^3 cells."""
    model = Model(Suspension(radius=0.25e-6), 0.4e-6, 60, 0.5)
    printed(model.fluid_mass, "1.0667e-18")
    assert 15**3 * model.density == pytest.approx(2.0e5, rel=0.02)


def test_reduced_units() -> None:
    assert REFLECTING.reduced_radius == pytest.approx(2)
    assert REFLECTING.reduced_mass == pytest.approx(2.5 * 3.9 * 4 / 3 * math.pi * 8)
    # settling by a diameter takes the same time in reduced units
    friction = 6 * math.pi * REFLECTING.reduced_viscosity * REFLECTING.reduced_radius
    speed = REFLECTING.reduced_mass * REFLECTING.reduced_gravity / friction
    time = 2 * REFLECTING.reduced_radius / speed * REFLECTING.time_unit
    assert time == pytest.approx(ALUMINA.time_scales().settling, rel=1e-12)
    diffusion = 1 / friction * REFLECTING.cell**2 / REFLECTING.time_unit
    assert diffusion == pytest.approx(ALUMINA.diffusion_coefficient, rel=1e-12)
    assert REFLECTING.knudsen == pytest.approx(0.3)
    assert REFLECTING.mach < 0.02
    assert 0 < REFLECTING.schmidt < 10


def test_interaction_keeps_energies_over_thermal_energy() -> None:
    model = Model(Suspension(radius=0.25e-6), 0.4e-6, 60, 0.5)
    dlvo = model.interaction(50e-3, 3e8, hertz=100.0, depth=6.0)
    assert dlvo.hamaker == pytest.approx(4.76e-20 / (1.38e-23 * 300))
    r = 0.52e-6
    joules = coulomb_strength(50e-3, 300) * 0.5e-6**2 / r * math.exp(-3e8 * (r - 0.5e-6))
    assert dlvo.coulomb_energy(r / model.cell) == pytest.approx(joules / (1.38e-23 * 300))
    barrier = dlvo.energy([dlvo.diameter * (1 + 0.0002 * k) for k in range(1, 500)]).max()
    assert barrier == pytest.approx(220, rel=0.05)  # kBT; it shuts the primary minimum


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [("0.4 um", "m", 4e-7), ("300 K", "K", 300), ("20 mV", "V", 0.02), ("3e8 / m", "1/m", 3e8)],
)
def test_quantities(value: str, unit: str, expected: float) -> None:
    assert si(value, unit) == pytest.approx(expected, rel=1e-14)
    assert si(expected, unit) == expected


@pytest.mark.parametrize(
    ("value", "unit", "complaint"),
    [
        ("0.4 K", "m", r"0.4 K: is a quantity of \[temperature\], must be one of \[length\]"),
        ("0.4 parsnips", "m", "0.4 parsnips: not a quantity in m"),
        ("", "m", "not a quantity in m"),
    ],
)
def test_a_wrong_quantity_is_named(value: str, unit: str, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        si(value, unit)


def test_wrong_fields_are_named() -> None:
    with pytest.raises(ValueError, match="radius -1"):
        Suspension(radius=-1)
    with pytest.raises(ValueError, match="density 1: must be more than 1"):
        Model(ALUMINA, 1e-7, 1, 0.5)


def test_a_lost_order_is_told() -> None:
    coarse = Model(ALUMINA, 8e-7, 2.5, 0.1)
    assert any("momentum in the fluid" in line for line in coarse.time_scales().lost_order())
