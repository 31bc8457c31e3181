"""What scenes of soft particles have in common (delhommelle-2005, II).

Units are those of the pair potential: its sigma, its epsilon and the mass of a particle are 1.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from lammps_inputs.placement import Hexagonal, LastFrame, Lattice, Random
from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import SIZES, TRAJECTORY, Box, Clock, Placement, Rest

STARTS = ("crystal", "random")
PARTICLES = {2: 896, 3: 1000}
DENSITY = {2: 1.03, 3: 0.84}
TEMPERATURE = {2: 1.0, 3: 0.722}
NEAREST = 0.7  # of the spacing, in a random start: half of what can be packed at random
ELONGATED = 1.5  # edges of the box of a crystal, at most
LOOKS = 20  # of the averages in a sampling interval, at least where it has so many steps
LOOK_STEPS = 100
FLIGHT = 0.15  # of a particle in a step, half the skin of the neighbour lists [sigma]
FASTEST = 5.0  # thermal speeds that a particle must be able to have


class SoftScene(Scene):
    """Fields of a periodic box of soft particles, and what is refused of them."""

    dimension: Literal[2, 3] = Field(
        default=2, description="2: soft disks, (sigma/r)^12; 3: Weeks-Chandler-Andersen spheres"
    )
    particles: Annotated[int, Field(ge=2, le=10**7)] | None = Field(
        default=None, description="number N; none: 896 in 2D, 1000 in 3D"
    )
    density: Annotated[float, Field(gt=0, le=1.3)] | None = Field(
        default=None, description="number density n [1/sigma^d]; none: 1.03 in 2D, 0.84 in 3D"
    )
    temperature: Annotated[float, Field(gt=0, le=100)] | None = Field(
        default=None, description="temperature T [epsilon]; none: 1 in 2D, 0.722 in 3D"
    )
    damping: Positive = Field(
        default=10.0, description="Q of the configurational thermostat [m sigma^4/epsilon]"
    )
    time_step: Annotated[float, Field(gt=0, le=0.01)] = Field(
        default=0.001, description="time step [t0]"
    )
    rest: NonNegative = Field(
        default=20.0,
        description="time at rest before the run, by the kinetic thermostat [t0]",
    )
    sampling_interval: Positive = Field(
        default=5.0, description="time between two outputs, at least two steps [t0]"
    )
    duration: Positive = Field(default=500.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=500.0, description="time left out [t0]")
    start: str = Field(
        default="crystal",
        description="crystal, random, or the directory of a run that has gone before",
    )

    @field_validator("particles", "density", "temperature", mode="before")
    @classmethod
    def _by_dimension(cls, value: Any) -> Any:
        return None if value == "none" else value

    @property
    def number(self) -> int:
        """N."""
        return self.particles or PARTICLES[self.dimension]

    @property
    def set_temperature(self) -> float:
        """T [epsilon]."""
        return self.temperature or TEMPERATURE[self.dimension]

    @property
    def number_density(self) -> float:
        """n [1/sigma^d]."""
        return self.density or DENSITY[self.dimension]

    @property
    def potential(self) -> SoftDisk | WeeksChandlerAndersen:
        """Of every pair."""
        return SoftDisk() if self.dimension == 2 else WeeksChandlerAndersen()

    @property
    def cells(self) -> tuple[int, int] | None:
        """Columns and rows of the triangular lattice of N disks nearest to a square, if any."""
        half, odd = divmod(self.number, 2)
        if odd:
            return None
        pairs = [(half // rows, rows) for rows in range(1, half + 1) if half % rows == 0]
        return min(pairs, key=_elongation)

    def box(self) -> Box:
        """That of a crystal in 2D, a cube in 3D."""
        if self.dimension == 3:
            edge = (self.number / self.number_density) ** (1 / 3)
            return Box((edge,) * 3, periodic=(True,) * 3)
        columns, rows = self.cells or (self.number, 1)
        spacing = math.sqrt(2 / (math.sqrt(3) * self.number_density))
        return Box((columns * spacing, rows * math.sqrt(3) * spacing), periodic=(True, True))

    @property
    def begins_anew(self) -> bool:
        """Whether it does not begin as another run ended."""
        return self.start in STARTS

    def placement(self) -> Placement:
        """Of the start."""
        if not self.begins_anew:
            return LastFrame(str(Path(self.start) / TRAJECTORY.file))
        if self.start == "random":
            return Random(NEAREST * self.number_density ** (-1 / self.dimension))
        if self.dimension == 3:
            return Lattice()
        return Hexagonal(*(self.cells or (self.number, 1)))

    def resting(self) -> Rest | None:
        """The rest before the run, but after another one."""
        steps = round(self.rest / self.time_step) if self.begins_anew else 0
        return Rest(steps, self.set_temperature) if steps else None

    def clock(self) -> Clock:
        """Whole outputs; averages of every hundredth step, or of more where outputs are dense."""
        steps = max(2, round(self.sampling_interval / self.time_step))
        longest = max(1, min(LOOK_STEPS, steps // min(LOOKS, steps // 2)))
        look = next(step for step in range(longest, 0, -1) if steps % step == 0)
        run = self.equilibration + self.duration
        outputs = max(1, math.ceil(run / self.time_step / steps - 1e-9))
        return Clock(
            time_step=self.time_step,
            steps_per_collision=1,
            sample_steps=steps,
            look_steps=look,
            equilibration_steps=round(self.equilibration / self.time_step),
            total_steps=outputs * steps,
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        cells = self.cells
        if self.dimension == 2 and (cells is None or _elongation(cells) > ELONGATED):
            nearest = min(_crystals(self.number), key=lambda number: abs(number - self.number))
            yield (
                f"particles = {self.number!r}: no nearly square crystal has so many disks; "
                f"{nearest} would do"
            )
            return
        box = self.box()
        needed = 2 * self.potential.cutoff
        for name, size in zip(SIZES, box.sizes, strict=False):
            if size < needed:
                yield (
                    f"particles = {self.number!r}: leave a {name} of {size:.3g}; twice the range "
                    f"of the potential, {needed:.3g}, is needed"
                )
                break
        if 0 < self.rest < self.time_step / 2:
            yield f"rest = {self.rest!r}: shorter than half a time step of {self.time_step!r}"
        flight = self.time_step * FASTEST * math.sqrt(self.set_temperature)
        if flight > FLIGHT:
            yield (
                f"time_step = {self.time_step!r}: too long for a temperature of "
                f"{self.set_temperature!r}: particles fly past each other; must be at most "
                f"{self.time_step * FLIGHT / flight:.2g}"
            )


def _elongation(cells: tuple[int, int]) -> float:
    """The longer edge over the shorter."""
    aspect = cells[0] / (math.sqrt(3) * cells[1])
    return max(aspect, 1 / aspect)


def _crystals(number: int) -> list[int]:
    """Numbers of disks of nearly square crystals, about as many."""
    rows = max(1, math.isqrt(round(number / (2 * math.sqrt(3)))))
    return [
        2 * columns * row
        for row in range(max(1, rows - 1), rows + 3)
        for columns in range(max(1, row), 3 * row + 2)
        if _elongation((columns, row)) <= ELONGATED
    ]
