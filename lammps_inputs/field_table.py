"""The fields of a scene as rows to be read: name, unit, default, what is allowed, meaning."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel
from pydantic.fields import FieldInfo

UNIT = re.compile(r" ?\[([^\]]+)\]")
BOUNDS = {Gt: ("above", "gt"), Ge: ("at least", "ge"), Lt: ("below", "lt"), Le: ("at most", "le")}
WORDS = {NoneType: "none", bool: "0 | 1", str: "text"}


@dataclass(frozen=True)
class FieldRow:
    """A field of a scene.

    Attributes:
        name: as `--set` takes it.
        unit: of plain numbers; "" where it is a word or a pure number.
        default: value without the field.
        allowed: values, bounds of a number; what depends on other fields is not in it.
        meaning: one line.
    """

    name: str
    unit: str
    default: str
    allowed: str
    meaning: str


def field_rows(scene: type[BaseModel]) -> list[FieldRow]:
    """The fields of a scene, in its order.

    >>> from lammps_inputs.scenes import all_scenes
    >>> next(row for row in field_rows(all_scenes()["channel"]) if row.name == "angle")
    FieldRow(name='angle', unit='degrees', default='90', allowed='above 0, at most 180', \
meaning='rotation angle alpha of the collision')
    """
    rows = []
    for name, field in scene.model_fields.items():
        description = field.description or ""
        unit = UNIT.search(description)
        rows.append(
            FieldRow(
                name,
                unit[1] if unit else "",
                "required" if field.is_required() else shown_default(field.default),
                _allowed(field.annotation, field.metadata),
                UNIT.sub("", description, count=1),
            )
        )
    return rows


def shown_default(value: Any) -> str:
    """A default value as tables show it."""
    if value is None:
        return "none"
    if isinstance(value, tuple):
        return ", ".join(map(shown_default, value))
    return value if isinstance(value, str) else f"{value:g}"


def _allowed(annotation: Any, metadata: Iterable[Any]) -> str:
    """What an annotation lets pass, in words; the metadata are those that stand around it."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _allowed(arguments[0], [*metadata, *arguments[1:]])
    if origin in (Union, UnionType):
        return "; or ".join(_allowed(alternative, metadata) for alternative in arguments)
    if origin is Literal:
        return " | ".join(map(str, arguments))
    if origin is tuple:
        return f"list, each {_allowed(arguments[0], metadata)}"
    if annotation in WORDS:
        return WORDS[annotation]
    bounds = list(_bounds(metadata))
    if annotation is int:
        bounds.insert(0, "whole number")
    return ", ".join(bounds or ["number"])


def _bounds(metadata: Iterable[Any]) -> Iterator[str]:
    for each in metadata:
        if isinstance(each, FieldInfo):
            yield from _bounds(each.metadata)
        for kind, (word, attribute) in BOUNDS.items():
            if isinstance(each, kind):
                value = getattr(each, attribute)
                yield f"{word} {value if isinstance(value, int) else f'{value:g}'}"
