"""Hard spheres in a periodic box, whose colours react about central ones: D(r) of carmer-2012."""

import math
from collections.abc import Iterator
from typing import ClassVar

from pydantic import Field

from lammps_inputs.close_packing import ClosePacking
from lammps_inputs.color_outputs import EVENT_AVERAGES, color_outputs
from lammps_inputs.engines.events import SHORTEST
from lammps_inputs.hard_spheres import DIAMETER, HardSphereScene
from lammps_inputs.scene import Positive
from lammps_inputs.system import Box, Reactions, System


class BulkSpheres(HardSphereScene):
    """Hard spheres in a periodic cube.

    Colours react at contact with central spheres, and on entering the sphere of radius `cutoff`
    about one; each central sphere has colours of its own.
    """

    name: ClassVar[str] = "bulk_spheres"
    paper: ClassVar[str] = "carmer-2012"

    centers: int = Field(default=20, ge=1, le=1000, description="central spheres")
    cutoff: Positive = Field(default=5.0, description="radius of the outer surface R_cut [a0]")
    duration: Positive = Field(default=1000.0, description="time after equilibration [t0]")

    @property
    def edge(self) -> float:
        """Of the cube [a0]."""
        return float(self.volume ** (1 / 3))

    def build(self) -> System:
        reactions = Reactions(self.reaction_probabilities, centers=self.centers, cutoff=self.cutoff)
        return System(
            box=Box((self.edge,) * 3, periodic=(True,) * 3),
            clock=self.clock(),
            species=(self.species(),),
            placement=ClosePacking(),
            interactions=self.interactions(),
            motion=self.motion(),
            reactions=None if self.soft else reactions,
            outputs=self.written(EVENT_AVERAGES, *color_outputs(len(self.reaction_probabilities))),
            measures=self.measured(),
        )

    def fit_problems(self) -> Iterator[str]:
        if self.edge < SHORTEST * DIAMETER:
            fewest = self.particles * (SHORTEST * DIAMETER / self.edge) ** 3
            yield (
                f"particles = {self.particles!r}: a cube of edge {self.edge:.3g}; it must have at "
                f"least {SHORTEST * DIAMETER:g}, with at least {math.ceil(fewest)} particles"
            )
            return
        if self.centers > self.particles:
            yield f"centers = {self.centers!r}: there are {self.particles} particles"
        if not DIAMETER < self.cutoff < self.edge / 2:
            yield (
                f"cutoff = {self.cutoff!r}: must be above {DIAMETER:g} and below half the edge of "
                f"the cube, {self.edge / 2:.4g}"
            )
        yield from super().fit_problems()
