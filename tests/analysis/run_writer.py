"""Writes small run directories by hand, byte for byte in the formats LAMMPS writes.

Time step 0.1, an output every 10 steps (t = 1), equilibration of 50 steps (t = 5).
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from run_files.manifest import FORMAT

Array = NDArray[np.float64]
Json = dict[str, Any]

TRAJECTORY = {
    "file": "trajectory.lammpsdump",
    "kind": "trajectory",
    "columns": ["id", "type", "x", "y", "z", "vx", "vy", "vz", "ix", "iy", "iz"],
}
PROFILE = {
    "file": "fluid_profile.dat",
    "kind": "profile",
    "columns": ["Coord1", "Ncount", "density/number", "vx", "temp"],
}
AVERAGES = {
    "file": "observables.dat",
    "kind": "table",
    "columns": ["fluid_temperature", "mean_velocity_x"],
}
OF_COLLOIDS = ["settling_speed", "colloid_temperature", "diffusion", "space_time", "snapshot"]
OF_PAIRS = ["spacings", "pair_correlation", "overlaps"]


def system_of_fluid(width: float, periodic: bool, measures: list[str], **clock: Any) -> Json:
    """A 2D fluid in a box of length 40, with walls across y where that is not periodic."""
    sides = () if periodic else ("lower", "upper")
    return {
        "box": {"sizes": [40.0, width], "periodic": [True, periodic]},
        "clock": {
            "time_step": 0.1,
            "steps_per_collision": 1,
            "sample_steps": 10,
            "look_steps": 10,
            "equilibration_steps": 50,
            "total_steps": 20_000,
            **clock,
        },
        "species": [],
        "interactions": [],
        "walls": [{"axis": 1, "side": side, "potentials": []} for side in sides],
        "drives": [],
        "motion": {"class": "VelocityVerlet"},
        "solvent": {
            "particles": 4000,
            "density": 10.0,
            "collision_time": 0.1,
            "angle": 90.0,
            "rotation": "coordinate_axes",
            "hydrodynamics": "on",
            "thermostat": "layer",
            "shear_wave": 0.0,
            "viscosity_theory": 0.75,
        },
        "outputs": [PROFILE, AVERAGES],
        "measures": ["fluid_temperature", *measures],
    }


def drive(target: str, magnitude: float) -> Json:
    """An acceleration along x [a0/t0^2]."""
    along_x = {"direction": [1.0, 0.0, 0.0], "variable": "gravity"}
    return {"target": target, "magnitude": magnitude, **along_x}


def slit(gravity: float, **clock: Any) -> Json:
    """The pure fluid between walls 10 apart, driven."""
    system = system_of_fluid(10.0, False, ["parabolic_flow"], **clock)
    return system | {"drives": [drive("fluid", gravity)]}


def bulk(shear_wave: float, **clock: Any) -> Json:
    """The periodic fluid, 32 wide."""
    measures = ["shear_wave"] if shear_wave else []
    system = system_of_fluid(32.0, True, measures, **clock)
    system["solvent"]["shear_wave"] = shear_wave
    return system


def channel(colloids: int, **clock: Any) -> Json:
    """Colloids of mass 100 in the slit; gravity pulls them."""
    measures = ["slit_flow", *OF_COLLOIDS]
    measures += OF_PAIRS if colloids >= 2 else []
    measures += ["zigzag"] if colloids >= 3 else []
    species = {"name": "colloids", "count": colloids, "mass": 100.0, "radius": 2.0}
    return system_of_fluid(10.0, False, measures, **clock) | {
        "species": [species],
        "drives": [drive("colloids", 0.1)],
        "outputs": [TRAJECTORY, PROFILE, AVERAGES],
    }


def write_manifest(
    path: Path, scene: str, system: Mapping[str, Any], fields: Json | None = None
) -> None:
    """The manifest of a run by fix srd."""
    path.mkdir(exist_ok=True)
    manifest = {
        "format": FORMAT,
        "engine": "srd",
        "scene": scene,
        "fields": fields or {},
        "units": {"length": "a0"},
        "system": system,
        "seeds": {"seed": 1},
    }
    (path / "manifest.json").write_text(json.dumps(manifest))


def write_observables(path: Path, temperature: Array, velocity: Array) -> None:
    """temperature and velocity: (K,)."""
    lines = [
        "# Time-averaged data for fix observables",
        "# TimeStep v_fluid_temperature v_mean_velocity_x",
    ]
    for interval, (kelvin, speed) in enumerate(zip(temperature, velocity, strict=True)):
        lines.append(f"{10 * (interval + 1)} {kelvin:.10g} {speed:.10g}")
    (path / "observables.dat").write_text("\n".join(lines) + "\n")


def write_profile(path: Path, y: Array, counts: Array, velocity: Array) -> None:
    """counts and velocity: (K, bins)."""
    lines = [
        "# Chunk-averaged data for fix profile and group fluid",
        "# Timestep Number-of-chunks Total-count",
        "# Chunk Coord1 Ncount density/number vx temp",
    ]
    for interval in range(len(counts)):
        lines.append(f"{10 * (interval + 1)} {len(y)} {counts[interval].sum():g}")
        lines += [
            f"  {n + 1} {y[n]:g} {counts[interval, n]:.10g} 1 {velocity[interval, n]:.10g} 1"
            for n in range(len(y))
        ]
    (path / "fluid_profile.dat").write_text("\n".join(lines) + "\n")


def write_trajectory(
    path: Path, positions: Array, velocities: Array, length: float = 40.0, width: float = 10.0
) -> None:
    """positions: unwrapped, (T, N, 2); wrapped along x on writing."""
    lines = []
    for frame in range(len(positions)):
        lines += ["ITEM: TIMESTEP", str(10 * frame)]
        lines += ["ITEM: NUMBER OF ATOMS", str(positions.shape[1])]
        lines += ["ITEM: BOX BOUNDS pp ff pp"]
        lines += [f"{low:.16e} {high:.16e}" for low, high in ((0, length), (0, width), (-0.5, 0.5))]
        lines += ["ITEM: ATOMS id type x y z vx vy vz ix iy iz"]
        for n, ((x, y), (vx, vy)) in enumerate(
            zip(positions[frame], velocities[frame], strict=True)
        ):
            image = int(np.floor(x / length))
            x -= image * length
            lines.append(f"{n + 1} 1 {x:.10g} {y:.10g} 0 {vx:.10g} {vy:.10g} 0 {image} 0 0")
    (path / "trajectory.lammpsdump").write_text("\n".join(lines) + "\n")


def half_cells(width: float) -> Array:
    """Centres of bins of half a cell."""
    return np.asarray(np.arange(0.25, width, 0.5))


def write_channel(
    path: Path, positions: Array, velocities: Array, mean_velocity: Array, **clock: Any
) -> None:
    """A channel run of T frames, so T - 1 sampling intervals, fluid at rest and at T = 1."""
    intervals = len(positions) - 1
    write_manifest(path, "channel", channel(positions.shape[1], **clock))
    write_trajectory(path, positions, velocities)
    write_observables(path, np.ones(intervals), mean_velocity)
    y = half_cells(10.0)
    write_profile(path, y, np.full((intervals, len(y)), 200.0), np.zeros((intervals, len(y))))
