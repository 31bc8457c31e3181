"""Writes small run directories, byte for byte in the formats LAMMPS writes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CHANNEL = {
    "length": 40.0,
    "width": 10.0,
    "density": 10.0,
    "collision_time": 0.1,
    "angle": 90.0,
    "hydrodynamics": "on",
    "gravity": 0.1,
    "colloid_radius": 2.0,
}
POISEUILLE = {key: CHANNEL[key] for key in CHANNEL if key != "colloid_radius"} | {"gravity": 0.001}
BULK = {key: POISEUILLE[key] for key in POISEUILLE if key != "gravity"} | {
    "width": 32.0,
    "shear_wave": 0.1,
    "rotation": "coordinate_axes",
}


def write_manifest(path: Path, scene: str, fields: dict[str, Any], /, **changes: Any) -> None:
    """time step 0.1, output every 10 steps (t = 1), equilibration 50 steps (t = 5)."""
    path.mkdir(exist_ok=True)
    colloids = changes.get("colloids", 0)
    manifest = {
        "narrows": "0.1.0",
        "engine": "srd",
        "scene": scene,
        "fields": fields,
        "dimension": 2,
        "time_step": 0.1,
        "steps_per_collision": 1,
        "sample_steps": 10,
        "fluid_looks": 1,
        "equilibration_steps": 50,
        "total_steps": 20_000,
        "fluid_particles": 4000,
        "colloids": colloids,
        "colloid_mass": 100.0 if colloids else None,
        "viscosity_theory": 0.75,
    }
    (path / "manifest.json").write_text(json.dumps(manifest | changes))


def write_observables(path: Path, temperature: Array, velocity: Array) -> None:
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
    return np.asarray(np.arange(0.25, width, 0.5))


def write_channel(
    path: Path, positions: Array, velocities: Array, mean_velocity: Array, **changes: Any
) -> None:
    """A channel run of T frames, so T - 1 sampling intervals, fluid at rest and at T = 1."""
    intervals = len(positions) - 1
    write_manifest(path, "channel", CHANNEL, colloids=positions.shape[1], **changes)
    write_trajectory(path, positions, velocities)
    write_observables(path, np.ones(intervals), mean_velocity)
    y = half_cells(10.0)
    write_profile(path, y, np.full((intervals, len(y)), 200.0), np.zeros((intervals, len(y))))
