"""Hard spheres between hard walls, whose colours react there: D(z) of carmer-2012."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from lammps_inputs.close_packing import ClosePacking
from lammps_inputs.color_outputs import SLIT_EVENT_AVERAGES, color_outputs
from lammps_inputs.engines.events import SHORTEST
from lammps_inputs.hard_spheres import DIAMETER, SPHERES, HardSphereScene
from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.scene import Positive
from lammps_inputs.system import Box, Reactions, System, slit

ACROSS = 2  # the axis of the walls
STIFFEST = 0.2  # time step over the time constant of a wall


class Pore(HardSphereScene):
    """Hard spheres between hard walls across z, periodic along x and y.

    Colours react at the walls. `packing_fraction` is N pi / (6 A width), A the area of a wall, with
    either meaning of the width: carmer-2012 does not say which is meant (docs/errata.md). Soft
    spheres have walls that push back where they overlap them, and leave paths, on which colours
    can be laid afterwards.
    """

    name: ClassVar[str] = "pore"
    paper: ClassVar[str] = "carmer-2012"

    width: Positive = Field(default=5.0, description="of the pore H [a0]")
    width_means: Literal["walls", "centres"] = Field(
        default="walls",
        description="width from wall to wall, or that of the space open to centres, 1 less",
    )

    wall_stiffness: Annotated[float, Field(gt=0, le=1e5)] = Field(
        default=1e4, description="k of the harmonic walls of soft spheres [kBT/a0^2]"
    )

    @property
    def separation(self) -> float:
        """From wall to wall [a0]."""
        return self.width + (DIAMETER if self.width_means == "centres" else 0.0)

    @property
    def edge(self) -> float:
        """Of a wall, a square [a0]."""
        return math.sqrt(self.volume / self.width)

    def build(self) -> System:
        wall = HarmonicWall(DIAMETER / 2, self.wall_stiffness)
        reactions = Reactions(self.reaction_probabilities, axis=ACROSS)
        return System(
            box=Box((self.edge, self.edge, self.separation), periodic=(True, True, False)),
            clock=self.clock(),
            species=(self.species(),),
            placement=ClosePacking(),
            interactions=self.interactions(),
            walls=slit(ACROSS, ((SPHERES, wall),) if self.soft else ()),
            motion=self.motion(),
            reactions=None if self.soft else reactions,
            outputs=self.written(
                SLIT_EVENT_AVERAGES, *color_outputs(len(self.reaction_probabilities))
            ),
            measures=self.measured(),
        )

    def fit_problems(self) -> Iterator[str]:
        if self.separation <= DIAMETER:
            yield (
                f"width = {self.width!r}: walls must be further apart than a diameter; must be "
                f"above {DIAMETER:g}, or width_means = 'centres'"
            )
        elif self.soft and self.time_step * math.sqrt(self.wall_stiffness) > STIFFEST:
            yield (
                f"wall_stiffness = {self.wall_stiffness!r}: too stiff for a time step of "
                f"{self.time_step!r}; must be at most {(STIFFEST / self.time_step) ** 2:.3g}"
            )
        elif self.edge < SHORTEST * DIAMETER:
            fewest = self.particles * (SHORTEST * DIAMETER / self.edge) ** 2
            yield (
                f"particles = {self.particles!r}: walls of edge {self.edge:.3g}; they must have at "
                f"least {SHORTEST * DIAMETER:g}, with at least {math.ceil(fewest)} particles"
            )
        else:
            yield from super().fit_problems()
