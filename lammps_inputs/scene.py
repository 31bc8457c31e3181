"""What every scene has: an MPC fluid, a duration, a seed; and the errors that refuse a bad one.

Reduced MPC units throughout: the collision cell a0, the thermal energy kBT and the fluid particle
mass m_f are 1, so times are in t0 = a0 sqrt(m_f / kBT) and velocities in a0 / t0
(tabatabaei-2009, 3.2.3 and 3.4.1).
"""

import math
import tomllib
from collections.abc import Iterable
from typing import Annotated, Any, ClassVar, Literal, Self

import tomli_w
from pydantic import BaseModel, ConfigDict, Field, ValidationError

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]

MAX_COLLISIONS_PER_LOOK = 10  # velocities of the fluid decorrelate in a few collisions

Hydrodynamics = Literal["on", "shuffle", "bath"]
Thermostat = Literal["none", "layer", "monte_carlo", "maxwell_boltzmann", "rescale", "andersen"]
Rotation = Literal["random_axis", "coordinate_axes"]


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
        return cls([f"{field} = {value!r}: {allowed}"])


class FluidScene(BaseModel):
    """The fields that all scenes share.

    Scenes are frozen and refuse unknown fields and numbers that are not finite. Build one with
    `make`, which raises `SceneError`; the constructor raises pydantic's own error.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, strict=False)

    name: ClassVar[str]
    walls: ClassVar[bool]

    length: Positive = Field(description="box length along the periodic x axis [a0]")
    width: Positive = Field(description="box width along y [a0]")
    density: Annotated[float, Field(gt=0, le=1000)] = Field(
        default=10.0, description="fluid particles per collision cell n_f [1/a0^d]"
    )
    collision_time: Positive = Field(description="time between two collisions tau_c [t0]")
    angle: Annotated[float, Field(gt=0, le=180)] = Field(
        default=90.0, description="rotation angle alpha of the collision [degrees]"
    )
    hydrodynamics: Hydrodynamics = Field(
        default="on",
        description="on; or a random solvent: shuffle (velocities interchanged), bath (redrawn)",
    )
    thermostat: Thermostat = Field(default="layer", description="thermostat of the fluid")
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
    def make(cls, **fields: Any) -> Self:
        """A scene from field values.

        Raises:
            SceneError: naming each wrong field, its value and what is allowed.
        """
        try:
            scene = cls(**fields)
        except ValidationError as error:
            raise SceneError(cls._field_problems(error)) from None
        problems = list(scene.problems())
        if problems:
            raise SceneError(problems)
        return scene

    @property
    def dimensions(self) -> int:
        """Number of space dimensions."""
        return 2

    @property
    def box(self) -> tuple[float, ...]:
        """Box lengths, one per dimension [a0]."""
        return (self.length, self.width)

    @property
    def periodic(self) -> tuple[bool, ...]:
        """Whether each axis is periodic; a slit has its walls at y = 0 and y = width."""
        return tuple(not (self.walls and axis == 1) for axis in range(self.dimensions))

    @property
    def fluid_particles(self) -> int:
        """Number of fluid particles N_f."""
        return round(self.density * math.prod(self.box))

    @property
    def time_step(self) -> float:
        """The engine's time step: that of MD where there is MD, else the collision time [t0]."""
        return self.collision_time

    @property
    def steps_per_collision(self) -> int:
        """Engine time steps between two collisions."""
        return 1

    @property
    def collisions_per_sample(self) -> int:
        """Collisions between two outputs: sampling_interval rounded, to at least two.

        So that an output averages at least two looks at the fluid.
        """
        return max(2, round(self.sampling_interval / self.collision_time))

    @property
    def collisions(self) -> int:
        """Collisions of the whole run, equilibration included, in whole sampling intervals."""
        total = (self.equilibration + self.duration) / self.collision_time
        return self.collisions_per_sample * max(
            1, math.ceil(total / self.collisions_per_sample - 1e-9)
        )

    @property
    def sample_steps(self) -> int:
        """Engine steps between two outputs."""
        return self.collisions_per_sample * self.steps_per_collision

    @property
    def total_steps(self) -> int:
        """Engine steps of the whole run."""
        return self.collisions * self.steps_per_collision

    @property
    def fluid_looks(self) -> int:
        """Evenly spaced looks at the fluid that one output averages, at least two.

        With a single one LAMMPS would also output at the step a run starts from.
        """
        sample = self.collisions_per_sample
        longest = min(MAX_COLLISIONS_PER_LOOK, sample // 2)
        return next(sample // every for every in range(longest, 0, -1) if sample % every == 0)

    def problems(self) -> Iterable[str]:
        """What is wrong with the combination of fields, one line each."""
        names = ("length", "width", "height")
        for axis, (size, periodic) in enumerate(zip(self.box, self.periodic, strict=True)):
            if periodic and size != round(size):
                yield (
                    f"{names[axis]} = {size!r}: a periodic length must be a whole number of "
                    "collision cells (a0 = 1)"
                )
            if size < 2:
                yield f"{names[axis]} = {size!r}: at least 2 collision cells are needed"
        if self.fluid_particles < 2:
            yield f"density = {self.density!r}: leaves {self.fluid_particles} fluid particles"

    @classmethod
    def _field_problems(cls, error: ValidationError) -> Iterable[str]:
        for item in error.errors():
            field = ".".join(str(part) for part in item["loc"]) or "scene"
            if item["type"] == "extra_forbidden":
                known = ", ".join(cls.model_fields)
                yield f"{field} = {item['input']!r}: unknown field; {cls.name} has {known}"
            else:
                reason = item["msg"].removeprefix("Value error, ").removeprefix("Input ")
                yield f"{field} = {item['input']!r}: {reason}"

    def toml(self) -> str:
        """The scene as the text of a scene file."""
        return tomli_w.dumps({"scene": self.name, **self.model_dump(exclude_none=True)})


def parse_assignment(text: str) -> tuple[str, Any]:
    """`field=value` of the command line as a pair; values are TOML, else a plain string.

    Raises:
        SceneError: when there is no `=`.
    """
    field, separator, value = text.partition("=")
    if not separator or not field.strip():
        raise SceneError([f"{text!r}: must have the form field=value"])
    try:
        return field.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return field.strip(), value.strip()
