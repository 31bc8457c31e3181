"""The scene of hecht-2005: its production runs, quantities with units, and all that it refuses."""

import math
from typing import Any

import numpy as np
import pytest

from lammps_inputs import SceneError, make_scene
from lammps_inputs.deck import check_engine, script
from lammps_inputs.initial_state import initial_state
from lammps_inputs.scenes.claylike import Claylike


def made(**fields: Any) -> Claylike:
    scene = make_scene("claylike", **fields)
    assert isinstance(scene, Claylike)
    return scene


@pytest.mark.parametrize("percent", [7, 14, 21, 28, 35])
def test_production_runs_have_the_colloids_of_the_paper(percent: int) -> None:
    """231 to 1155 in a cube of 6 um, 2.0e5 fluid particles, 2 us a step (X A)."""
    scene = made(volume_fraction=percent / 100)
    assert scene.colloids == 33 * percent
    assert scene.edge * scene.cells == pytest.approx(6e-6)
    assert scene.system.solvent is not None
    assert scene.system.solvent.particles == 202500
    step = scene.system.clock.time_step * scene.model.time_unit
    assert step == pytest.approx(2e-6, rel=0.002)
    assert scene.model.fluid_mass == pytest.approx(1.0667e-18, rel=1e-4)
    assert not list(scene.warnings())


def test_reflection_has_the_same_box() -> None:
    scene = made(coupling="reflection")
    assert scene.edge * scene.cells == pytest.approx(6e-6)
    assert scene.colloids == 462
    assert (scene.density, scene.mean_free_path) == (2.5, 0.6)
    assert made(coupling="reflection", density=5).density == 5


def test_quantities_of_the_laboratory() -> None:
    plain = made(radius=4e-7, kappa=2e8, surface_potential=0.02, temperature=300, duration=1000)
    unit = plain.model.time_unit
    text = made(
        radius="0.4 um",
        kappa="1/(5 nm)",
        surface_potential="20 mV",
        temperature="26.85 degC",
        duration=f"{1000 * unit!r} s",
        sampling_interval=f"{1e6 * unit!r} us",
    )
    for field, value in plain.model_dump(exclude_none=True).items():
        told = getattr(text, field)
        assert told == (value if isinstance(value, str) else pytest.approx(value, rel=1e-12))
    sheared = made(boundaries="bottom", shear_rate=f"{0.01 / plain.model.time_unit!r} 1/s")
    assert sheared.shear_rate == pytest.approx(
        0.01 * sheared.model.time_unit / plain.model.time_unit
    )


@pytest.mark.parametrize("coupling", ["cell", "reflection"])
def test_gravity_is_that_of_the_peclet_number(coupling: str) -> None:
    """(21) of the laboratory gives the model's gravity with buoyancy (31)."""
    scene = made(coupling=coupling)
    real = scene.model.suspension.time_scales().peclet
    assert real == pytest.approx(0.11, abs=0.005)  # IX A
    pulled = made(coupling=coupling, peclet=real)
    assert pulled.gravity == pytest.approx(scene.model.reduced_gravity, rel=1e-12)


def test_start_has_the_temperature_of_every_degree_of_freedom() -> None:
    scene = made(volume_fraction=0.35, cells=15)
    state = initial_state(scene.system, seed=3)
    species = scene.system.species[0]
    assert species.inertia == pytest.approx(0.4 * species.mass * species.radius**2)
    for inertia, values in (
        (species.mass, state.colloid_velocities),
        (species.inertia, state.colloid_spins),
    ):
        assert inertia * values.var() == pytest.approx(1, abs=5 * math.sqrt(2 / values.size))
    apart = scene.system.box.nearest_image(
        state.colloid_positions[:, None] - state.colloid_positions[None]
    )
    distance = np.sqrt((apart**2).sum(axis=-1))
    assert distance[distance > 0].min() >= 2 * species.radius


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "dimension of a length": ({"radius": "0.4 s"}, "radius = '0.4 s': .*is a quantity of"),
    "dimension of kappa": ({"kappa": "5 nm"}, "kappa = '5 nm': .*must be one of"),
    "dimension of a potential": ({"surface_potential": "20 mA"}, "is a quantity of"),
    "dimension of an energy": ({"hamaker": "4e-20 N"}, "hamaker = '4e-20 N': .*is a quantity"),
    "dimension of a temperature": ({"temperature": "3 m"}, "temperature = '3 m': .*is a quantity"),
    "dimension of a viscosity": ({"viscosity": "1e-3 Pa s"}, "viscosity = .*is a quantity of"),
    "dimension of a time": ({"duration": "3 m"}, "duration: 3 m: is a quantity of"),
    "dimension of a rate": (
        {"boundaries": "bottom", "shear_rate": "3 s"},
        "shear_rate: 3 s: is a quantity of",
    ),
    "no quantity": ({"radius": "small"}, "radius = 'small': small: not a quantity in m"),
    "a list": ({"radius": [1]}, "radius = .*must be a number in m or a quantity such as"),
    "not finite": ({"kappa": float("nan")}, "kappa = nan: "),
    "radius": ({"radius": -1e-7}, "radius = -1e-07: .*greater than or equal to 0.0000000001"),
    "temperature": ({"temperature": 0}, "temperature = 0: .*greater than or equal to 0.1"),
    "cells": ({"cells": 1.5}, "cells = 1.5: "),
    "density too low": ({"density": 0.5}, "density = 0.5: must be more than 1 fluid particle"),
    "density too high": ({"density": 2000}, "density = 2000: .*less than or equal to 1000"),
    "coupling": ({"coupling": "force"}, "coupling = 'force': .*'cell' or 'reflection'"),
    "potential": ({"potential": "yukawa"}, "potential = 'yukawa': .*'dlvo', 'hertz' or 'none'"),
    "boundaries": ({"boundaries": "closed"}, "boundaries = 'closed': "),
    "lubrication": ({"lubrication": "maybe"}, "lubrication = 'maybe': .*'on' or 'off'"),
    "hydrodynamics": ({"hydrodynamics": "off"}, "hydrodynamics = 'off': "),
    "unknown field": ({"gravity": 1}, "gravity = 1: unknown field; claylike has"),
    "thin double layer": ({"kappa": 1e7}, "kappa = 10000000.0: kappa R is 2.5; .* at least 5"),
    "overlap at the start": (
        {"volume_fraction": 0.6},
        "volume_fraction = 0.6: spheres overlap on the cubic lattice .*at most 0.523",
    ),
    "more than space": ({"volume_fraction": 0.8}, "volume_fraction = 0.8: .*less than 0.74"),
    "no colloid": ({"volume_fraction": 1e-5}, "volume_fraction = 1e-05: not one colloid"),
    "small box": ({"cells": 4}, "cells = 4: colloids would meet their own images"),
    "coarse sphere": (
        {"coupling": "reflection", "cell_edge": "0.4 um"},
        "cell_edge = 4e-07: a sphere that reflects has a radius of 0.625 cells; at least 1",
    ),
    "overlapping reflectors": (
        {"coupling": "reflection", "potential": "none"},
        "potential = 'none': spheres that reflect the fluid must not overlap",
    ),
    "stiff minimum": (
        {"md_steps_per_collision": 30, "lubrication": "off"},
        "md_steps_per_collision = 30: contact and the primary minimum are too stiff",
    ),
    "deep minimum": (
        {"minimum_depth": 3000.0},
        "md_steps_per_collision = 268: contact and the primary minimum are too stiff .* or "
        "minimum_depth = 3000.0",
    ),
    "stiff lubrication": (
        {"potential": "none", "md_steps_per_collision": 10},
        "md_steps_per_collision = 10: friction in contact takes",
    ),
    "stiff walls": (
        {"boundaries": "bottom", "md_steps_per_collision": 4, "potential": "none"},
        "md_steps_per_collision = 4: the walls are too stiff",
    ),
    "no walls to shear": (
        {"shear_rate": 0.01},
        "shear_rate = 0.01: needs walls across z, boundaries = 'bottom', not 'periodic'",
    ),
    "walls faster than sound": (
        {"boundaries": "bottom", "shear_rate": 0.5},
        "shear_rate = 0.5: the walls would move at 3.75, faster than sound",
    ),
    "settling faster than sound": ({"peclet": 1e3}, "peclet = 1000.0: colloids would settle at"),
    "upwards": ({"peclet": -1}, "peclet = -1: .*greater than or equal to 0"),
    "lighter than the fluid": (
        {"peclet": 1, "particle_density": 900},
        "particle_density = 900.0: must be more than that of the fluid",
    ),
    "layers in a capillary": (
        {"boundaries": "capillary", "thermostat": "layer"},
        "thermostat = 'layer': there must not be two pairs of walls",
    ),
    "heat without end": (
        {"peclet": 1, "thermostat": "none"},
        "thermostat = 'none': in a periodic box gravity heats without end",
    ),
    "no time": ({"duration": 0}, "duration = 0: .*greater than 0"),
    "seed": ({"seed": 0}, "seed = 0: .*greater than or equal to 1"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused_in_one_line_each(name: str) -> None:
    fields, message = BAD[name]
    with pytest.raises(SceneError, match=message) as refused:
        make_scene("claylike", **fields)
    assert all("\n" not in line for line in refused.value.problems)


def test_a_minimum_behind_a_high_barrier_is_no_problem() -> None:
    """At 50 mV and 3e8 / m 222 kBT shut the primary minimum, which 2 us could not follow."""
    scene = made(surface_potential="50 mV", kappa="3e8 / m")
    assert scene.between is not None
    assert scene.between.barrier == pytest.approx(222.6, abs=0.1)
    inside = math.sqrt(2 * scene.between.stiffness / scene.model.reduced_mass)
    assert inside * scene.system.clock.time_step > 0.5


@pytest.mark.parametrize("boundaries", ["periodic", "bottom", "capillary"])
@pytest.mark.parametrize("coupling", ["cell", "reflection"])
def test_the_deck_names_every_part(boundaries: str, coupling: str) -> None:
    rate = 0.02 if boundaries == "bottom" else 0
    scene = made(boundaries=boundaries, coupling=coupling, shear_rate=rate, peclet=1)
    check_engine(scene, "mpc")
    deck = script(scene, "mpc")
    known = {
        "periodic": ["compensate 0 0 $(-1.0*v_gravity:%.17g)", "momentum 100", "boundary p p p"],
        "bottom": [f"wall zlo {-scene.wall_speed!r} 0.0 0.0", "wall/harmonic zlo EDGE"],
        "capillary": ["boundary f f p", "xlo EDGE", "yhi EDGE"],
    }
    known["periodic"] += ["collide yes"] if coupling == "cell" else ["reflect 1 2.0 entry"]
    for word in (*known[boundaries], "fix motion colloids nve/sphere", "pair_style dlvo"):
        assert word in deck


def test_what_runs_but_is_inaccurate_is_told() -> None:
    warnings = " ".join(made(peclet=30, boundaries="bottom").warnings())
    assert "no longer slow against sound" in warnings
    relaxing = " ".join(made(particle_density=60000).warnings())
    assert "particles relax more slowly than the fluid" in relaxing


@pytest.mark.parametrize(
    ("fields", "warning"),
    [
        ({"cell_edge": "0.2 um"}, "cell_edge = 2e-07: spheres of 1.25 cells in radius"),
        ({"cell_edge": "0.26 um"}, None),
        (
            {"potential": "hertz", "hertz": 10},
            "hertz = 10.0: kBT presses spheres into each other by",
        ),
        ({"potential": "hertz", "hertz": 30}, None),
        ({"surface_potential": 0.0, "hertz": 10}, "hertz = 10.0: kBT presses spheres"),
        ({"surface_potential": 0.05, "kappa": 1e8, "hertz": 10}, None),  # a barrier of 600 kBT
        ({"potential": "none", "hertz": 10}, None),
    ],
)
def test_spheres_that_are_none_are_told(fields: dict[str, Any], warning: str | None) -> None:
    """Too large for their cell, or so soft that they pass through each other."""
    told = [line for line in made(**fields).warnings() if "order" not in line]
    assert (warning is None) == (not told), told
    assert warning is None or warning in told[0]
