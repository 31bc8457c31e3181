"""The flow of the fluid for other programs: VTK image data (ParaView, OVITO), or numpy arrays."""

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from analysis.arrays import Array
from analysis.flow_grid import FlowField

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
    ElementTree.ElementTree(_image(field)).write(path, encoding="utf-8", xml_declaration=True)


def _image(field: FlowField) -> ElementTree.Element:
    """VTK's image data in XML, the numbers in base64: OVITO reads no others."""
    dimensions = len(field.axes)
    steps = [float(axis[1] - axis[0]) if len(axis) > 1 else 1.0 for axis in field.axes]
    origin = [float(axis[0]) - step / 2 for axis, step in zip(field.axes, steps, strict=True)]
    flat = 3 - dimensions
    extent = _words([end for axis in field.axes for end in (0, len(axis))] + [0, 1] * flat)
    file = ElementTree.Element(
        "VTKFile",
        type="ImageData",
        version="1.0",
        byte_order="LittleEndian",
        header_type="UInt64",
    )
    image = ElementTree.SubElement(
        file,
        "ImageData",
        WholeExtent=extent,
        Origin=_words(origin + [0.0] * flat),
        Spacing=_words(steps + [1.0] * flat),
    )
    piece = ElementTree.SubElement(image, "Piece", Extent=extent)
    cells = ElementTree.SubElement(piece, "CellData", Scalars="count", Vectors="velocity")
    _add(cells, "count", field.counts[0][..., None])
    still = np.zeros((*field.counts[0].shape, flat))
    _add(cells, "velocity", np.concatenate([field.velocity[0], still], axis=-1))
    _add(cells, "temperature", field.temperature[0][..., None])
    return file


def _words(numbers: Sequence[float]) -> str:
    return " ".join(map(repr, numbers))


def _add(cells: ElementTree.Element, name: str, values: Array) -> None:
    """Values of each bin, (nx, ny, ..., components), written with x the fastest."""
    axes = values.ndim - 1
    ordered = np.ascontiguousarray(values.transpose(*reversed(range(axes)), axes), dtype="<f8")
    content = ordered.tobytes()
    array = ElementTree.SubElement(cells, "DataArray", Name=name, type="Float64", format="binary")
    array.set("NumberOfComponents", str(values.shape[-1]))
    if values.shape[-1] > 1:
        for n, axis in enumerate("XYZ"):
            array.set(f"ComponentName{n}", axis)
    length = len(content).to_bytes(8, "little")
    array.text = base64.b64encode(length + content).decode()
