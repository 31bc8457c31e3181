"""What every scene has: times, a seed, the system it stands for, and the errors that refuse it.

Reduced MPC units throughout: the collision cell a0, the thermal energy kBT and the fluid particle
mass m_f are 1, so times are in t0 = a0 sqrt(m_f / kBT) and velocities in a0 / t0
(tabatabaei-2009, 3.2.3 and 3.4.1).
"""

import inspect
import reprlib
import tomllib
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import tomli_w
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from lammps_inputs.comparison import Laboratory
from lammps_inputs.field_table import field_rows
from lammps_inputs.system import System

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]


LARGEST_FILE = 2**20  # bytes of a scene file
MOST = 2**31 - 1  # of what is counted, and of seeds
SMALLEST, LARGEST = 1e-9, 1e9  # of any number but 0: all that is computed from it stays a float


def shown(value: object) -> str:
    """A value as an error shows it: short, and whatever it is."""
    try:
        return reprlib.repr(value) if not isinstance(value, float | str) else _SHORT.repr(value)
    except (ValueError, RecursionError):  # an integer of more digits than Python prints
        return f"a {type(value).__name__}"


def shown_name(name: str) -> str:
    """A name as an error shows it."""
    return name if name.isprintable() and len(name) <= 100 else shown(name)


_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = 100


class SceneError(ValueError):
    """A scene that cannot be simulated: one line per offending field in `problems`."""

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = tuple(problems)
        super().__init__(self.problems)  # so that it survives pickling between processes

    def __str__(self) -> str:
        return "\n".join(self.problems)

    @classmethod
    def of_field(cls, field: str, value: object, allowed: str) -> Self:
        """The error for one field: its name, the value given and what is allowed."""
        return cls([f"{shown_name(field)} = {shown(value)}: {allowed}"])


class Scene(BaseModel, ABC):
    """A few named numbers that stand for a system; one subclass for each file of `scenes/`.

    Scenes are frozen and refuse unknown fields and numbers that are not finite. Build one with
    `make`, which raises `SceneError`; the constructor raises pydantic's own error.

    >>> from lammps_inputs import make_scene
    >>> scene = make_scene("channel", colloids=5, length=60)
    >>> scene.system.clock.total_steps
    1100250
    >>> [drive.target for drive in scene.system.drives]
    ['colloids']
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, strict=False)

    name: ClassVar[str]
    paper: ClassVar[str] = ""  # that the scene is of, as `narrows reproduce` names it
    si_fields: ClassVar[tuple[str, ...]] = ()  # which have bounds of their own

    duration: Positive = Field(description="simulated time after the equilibration [t0]")
    equilibration: NonNegative = Field(
        description="simulated time at the start that averages leave out [t0]"
    )
    sampling_interval: Positive = Field(
        default=1.0, description="time between two outputs, at least two collisions [t0]"
    )
    seed: Annotated[int, Field(ge=1, lt=2**31)] = Field(
        default=1, description="seed of every random stream"
    )

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """`help()` of a scene lists its fields."""
        fields = [
            f"    {row.name} = {row.default}{f' [{row.unit}]' if row.unit else ''}: {row.meaning}"
            for row in field_rows(cls)
        ]
        cls.__doc__ = "\n".join([inspect.cleandoc(cls.__doc__ or ""), "", "Fields:", *fields])

    @classmethod
    def make(cls, /, **fields: Any) -> Self:
        """A scene from field values.

        Raises:
            SceneError: naming each wrong field, its value and what is allowed.
        """
        try:
            scene = cls(**fields)
        except ValidationError as error:
            raise SceneError(cls._field_problems(error)) from None
        problems = list(scene._sizes()) or list(scene.problems())
        if problems:
            raise SceneError(problems)
        return scene

    @classmethod
    def of_laboratory(cls, **fields: Any) -> tuple[Self, Laboratory]:
        """The scene that stands for a system of the laboratory, and what it keeps of it.

        Raises:
            SceneError: for wrong fields, or a scene that stands for none.
        """
        raise SceneError([f"scene {cls.name}: stands for nothing in the laboratory"])

    def lasting(self, duration: float) -> Self:
        """The same scene with another duration [t0].

        Raises:
            SceneError: for a duration that it refuses.
        """
        return self.make(**(self.model_dump() | {"duration": duration}))

    def _sizes(self) -> Iterator[str]:
        """A line for each number that is beyond what any scene could mean."""
        for field, value in self:
            if isinstance(value, int | float) and value and field not in self.si_fields:
                largest = MOST if isinstance(value, int) else LARGEST
                if abs(value) > largest:
                    yield f"{field} = {shown(value)}: must be at most {largest:g} in size"
                elif abs(value) < SMALLEST:
                    yield f"{field} = {shown(value)}: must be 0, or at least {SMALLEST:g} in size"

    @cached_property
    def system(self) -> System:
        """The system that the scene stands for: all that engines and measures know of it."""
        return self.build()

    @property
    def si_units(self) -> dict[str, float]:
        """a0 [m], t0 [s], m_f [kg] and kBT [J], where the scene is of something in particular."""
        return {}

    @abstractmethod
    def build(self) -> System:
        """The parts of the system."""

    def problems(self) -> Iterator[str]:
        """What is wrong with the combination of fields, one line each: field, value, reason."""
        yield from ()

    def warnings(self) -> Iterator[str]:
        """What will be inaccurate, one line each: field, value, reason."""
        yield from ()

    @classmethod
    def _field_problems(cls, error: ValidationError) -> Iterable[str]:
        for item in error.errors():
            field = shown_name(".".join(str(part) for part in item["loc"]) or "scene")
            given = f"{field} = {shown(item['input'])}"
            if item["type"] == "extra_forbidden":
                known = ", ".join(cls.model_fields)
                yield f"{given}: unknown field; {cls.name} has {known}"
            elif item["type"] == "tuple_type":
                yield f"{given}: must be a list, such as [0.1, 1]"
            else:
                reason = item["msg"].removeprefix("Value error, ").removeprefix("Input ")
                yield f"{given}: {reason}"

    def toml(self) -> str:
        """The scene as the text of a scene file."""
        return tomli_w.dumps({"scene": self.name, **self.model_dump(exclude_none=True)})


def parse_assignment(text: str) -> tuple[str, Any]:
    """`field=value` of the command line as a pair; values are TOML, else a plain string.

    >>> parse_assignment("gravity = 1e-3")
    ('gravity', 0.001)
    >>> parse_assignment("thermostat=layer")
    ('thermostat', 'layer')

    Raises:
        SceneError: when there is no `=`, or more than one line.
    """
    field, separator, value = text.partition("=")
    if not separator or not field.strip():
        raise SceneError([f"{text!r}: must have the form field=value"])
    if "\n" in text.strip():
        raise SceneError([f"{text!r}: must be a single line; give every field its own --set"])
    try:
        return field.strip(), tomllib.loads(f"value = {value}")["value"]
    except (ValueError, RecursionError):
        return field.strip(), value.strip()


def read_scene(file: Path) -> dict[str, Any]:
    """The fields of a scene file, its name among them as `scene` when the file gives it.

    Raises:
        SceneError: when the file is missing or not TOML.
    """
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise SceneError([f"{file}: more than {LARGEST_FILE} bytes"])
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except SceneError:
        raise
    except (OSError, ValueError, RecursionError) as error:
        raise SceneError([f"{file}: {' '.join(str(error).split())}"]) from None
