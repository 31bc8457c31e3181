"""Hard spheres between hard walls, whose colours react there: D(z) of carmer-2012."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

from pydantic import Field

from lammps_inputs.close_packing import ClosePacking
from lammps_inputs.color_outputs import SLIT_EVENT_AVERAGES, color_outputs
from lammps_inputs.engines.events import SHORTEST
from lammps_inputs.hard_spheres import DIAMETER, HardSphereScene
from lammps_inputs.scene import Positive
from lammps_inputs.system import TRAJECTORY, Box, Events, Reactions, System, slit

ACROSS = 2  # the axis of the walls


class Pore(HardSphereScene):
    """Hard spheres between hard walls across z, periodic along x and y.

    Colours react at the walls. `packing_fraction` is N pi / (6 A width), A the area of a wall, with
    either meaning of the width: carmer-2012 does not say which is meant (docs/errata.md).
    """

    name: ClassVar[str] = "pore"
    paper: ClassVar[str] = "carmer-2012"

    width: Positive = Field(default=5.0, description="of the pore H [a0]")
    width_means: Literal["walls", "centres"] = Field(
        default="walls",
        description="width from wall to wall, or that of the space open to centres, 1 less",
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
        trajectory = (TRAJECTORY,) if self.trajectory else ()
        return System(
            box=Box((self.edge, self.edge, self.separation), periodic=(True, True, False)),
            clock=self.clock(),
            species=(self.species(),),
            placement=ClosePacking(),
            walls=slit(ACROSS),
            motion=Events(),
            reactions=Reactions(self.reaction_probabilities, axis=ACROSS),
            outputs=(
                *trajectory,
                SLIT_EVENT_AVERAGES,
                *color_outputs(len(self.reaction_probabilities)),
            ),
            measures=("color_diffusivity", "reacted_speeds", "hard_sphere_averages"),
        )

    def fit_problems(self) -> Iterator[str]:
        if self.separation <= DIAMETER:
            yield (
                f"width = {self.width!r}: walls must be further apart than a diameter; must be "
                f"above {DIAMETER:g}, or width_means = 'centres'"
            )
        elif self.edge < SHORTEST * DIAMETER:
            fewest = self.particles * (SHORTEST * DIAMETER / self.edge) ** 2
            yield (
                f"particles = {self.particles!r}: walls of edge {self.edge:.3g}; they must have at "
                f"least {SHORTEST * DIAMETER:g}, with at least {math.ceil(fewest)} particles"
            )
        else:
            yield from super().fit_problems()
