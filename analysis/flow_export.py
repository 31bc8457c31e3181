"""The flow of the fluid for other programs: VTK image data (ParaView, OVITO), or numpy arrays."""

from pathlib import Path
from typing import Any

import numpy as np
from pyevtk.hl import imageToVTK

from analysis.arrays import Array
from analysis.run_directory import FlowField

SUFFIXES = (".vti", ".npz")


def export(field: FlowField, path: Path) -> None:
    """Write a flow field, by the ending of the file.

    `.npz` has the arrays of `FlowField` by name, the axes as `x`, `y`, `z`. `.vti` has one average
    with a value for each bin: `count`, `velocity`, `temperature`.

    Raises:
        ValueError: for another ending, or several averages in a `.vti`.
        OSError: when the file cannot be written.
    """
    if path.suffix == ".npz":
        arrays: dict[str, Any] = {"steps": field.steps, "counts": field.counts}
        arrays |= {"velocity": field.velocity, "temperature": field.temperature}
        arrays |= dict(zip("xyz", field.axes, strict=False))
        with path.open("wb") as file:
            np.savez_compressed(file, **arrays)
        return
    if path.suffix != ".vti":
        raise ValueError(f"{path.name}: must end with {' or '.join(SUFFIXES)}")
    if len(field.steps) != 1:
        raise ValueError(f"{path.name}: of {len(field.steps)} averages; take their mean() first")
    velocity = [field.velocity[0, ..., axis] for axis in range(len(field.axes))]
    velocity += [np.zeros_like(velocity[0])] * (3 - len(velocity))
    steps = [_step(axis) for axis in field.axes]
    origin = [axis[0] - step / 2 for axis, step in zip(field.axes, steps, strict=True)]
    imageToVTK(
        str(path.with_suffix("")),
        origin=_three(origin, 0.0),
        spacing=_three(steps, 1.0),
        cellData={
            "count": _cells(field.counts[0]),
            "velocity": tuple(_cells(each) for each in velocity),
            "temperature": _cells(field.temperature[0]),
        },
    )


def _cells(values: Array) -> Array:
    """(nx, ny, nz), in the order that the library wants."""
    flat = values[..., None] if values.ndim == 2 else values
    return np.ascontiguousarray(flat)


def _step(axis: Array) -> float:
    return float(axis[1] - axis[0]) if len(axis) > 1 else 1.0


def _three(values: list[float], third: float) -> tuple[float, ...]:
    return (*values, third)[:3]
