"""Manifests of narrows 0.1, which named fields of its three scenes instead of parts."""

from typing import Any

TRAJECTORY = ("id", "type", "x", "y", "z", "vx", "vy", "vz", "ix", "iy", "iz")
PROFILE = ("Coord1", "Ncount", "density/number", "vx", "temp")
AVERAGES = ("fluid_temperature", "mean_velocity_x")


def from_narrows_0_1(old: dict[str, Any]) -> dict[str, Any]:
    """The present form of an old manifest, to be checked like any other.

    Gravity acted on the colloids, or where there were none on the fluid; an axis that was not
    periodic had walls. What potentials there were is not told.

    Raises:
        LookupError, TypeError, AttributeError, ValueError, ArithmeticError: when it is none.
    """
    fields, colloids = old["fields"], old["colloids"]
    sizes, periodic = old["box"], old["periodic"]
    walls = [
        {"axis": axis, "side": side, "potentials": ()}
        for axis, way in enumerate(periodic)
        for side in ("lower", "upper")
        if not way
    ]
    return {
        "format": 2,
        "engine": old["engine"],
        "scene": old["scene"],
        "fields": fields,
        "units": old["units"],
        "system": {
            "box": {"sizes": sizes, "periodic": periodic},
            "clock": {
                "time_step": old["time_step"],
                "steps_per_collision": old["steps_per_collision"],
                "sample_steps": old["sample_steps"],
                "look_steps": old["sample_steps"] // old["fluid_looks"],
                "equilibration_steps": old["equilibration_steps"],
                "total_steps": old["total_steps"],
            },
            "species": _colloids(old) if colloids else (),
            "interactions": (),
            "walls": walls,
            "drives": _gravity(fields, "colloids" if colloids else "fluid"),
            "motion": {"class": "VelocityVerlet"},
            "solvent": {
                "particles": old["fluid_particles"],
                "density": fields["density"],
                "collision_time": fields["collision_time"],
                "angle": fields["angle"],
                "rotation": fields.get("rotation", "coordinate_axes"),
                "hydrodynamics": fields["hydrodynamics"],
                "thermostat": fields["thermostat"],
                "shear_wave": fields.get("shear_wave", 0.0),
                "viscosity_theory": old["viscosity_theory"],
            },
            "outputs": _outputs(bool(colloids)),
            "measures": _measures(colloids, bool(walls), fields.get("shear_wave", 0.0)),
        },
        "seeds": old["seeds"],
        "versions": old.get("versions", {}),
        "command": old.get("command", ""),
        "ranks": old.get("ranks", 1),
    }


def _colloids(old: dict[str, Any]) -> tuple[dict[str, Any], ...]:
    radius = old["fields"]["colloid_radius"]
    colloids = {"count": old["colloids"], "mass": old["colloid_mass"], "radius": radius}
    return ({"name": "colloids", **colloids},)


def _gravity(fields: dict[str, Any], target: str) -> tuple[dict[str, Any], ...]:
    if "gravity" not in fields:
        return ()
    drive = {"magnitude": fields["gravity"], "direction": (1, 0, 0), "variable": "gravity"}
    return ({"target": target, **drive},)


def _outputs(colloids: bool) -> tuple[dict[str, Any], ...]:
    outputs = (
        ("trajectory.lammpsdump", "trajectory", TRAJECTORY),
        ("fluid_profile.dat", "profile", PROFILE),
        ("observables.dat", "table", AVERAGES),
    )
    return tuple(
        {"file": file, "kind": kind, "columns": columns}
        for file, kind, columns in outputs
        if colloids or kind != "trajectory"
    )


def _measures(colloids: int, walls: bool, shear_wave: float) -> tuple[str, ...]:
    measures = ["fluid_temperature"]
    if walls:
        measures.append("slit_flow" if colloids else "parabolic_flow")
    elif shear_wave:
        measures.append("shear_wave")
    if colloids:
        measures += ["settling_speed", "colloid_temperature", "diffusion", "space_time", "snapshot"]
    if colloids >= 2:
        measures += ["spacings", "pair_correlation", "overlaps"]
    if colloids >= 3:
        measures.append("zigzag")
    return tuple(measures)
