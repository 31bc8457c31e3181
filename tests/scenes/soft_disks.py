"""Two species of soft disks, driven against each other without a solvent."""

from typing import ClassVar

from pydantic import Field

from lammps_inputs.placement import Lattice
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import (
    PARTICLE_AVERAGES,
    TRAJECTORY,
    Box,
    Clock,
    Drive,
    Interaction,
    Species,
    System,
)


class SoftDisks(Scene):
    """Disks in a periodic square: half of them are pulled to the right, half to the left."""

    name: ClassVar[str] = "soft_disks"

    edge: Positive = Field(default=12.0, description="of the square [a0]")
    pulled_each_way: int = Field(default=40, ge=1, description="disks of each species")
    field: float = Field(default=1.0, description="acceleration of either species [a0/t0^2]")
    sampling_interval: Positive = Field(default=0.1, description="time between two outputs [t0]")
    duration: Positive = Field(default=4.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=0.0, description="time left out [t0]")

    def build(self) -> System:
        repulsion, number = RepulsiveMie(sigma=1.0, exponent=6), self.pulled_each_way
        pairs = (("right", "right"), ("right", "left"), ("left", "left"))
        return System(
            box=Box((self.edge, self.edge), periodic=(True, True)),
            clock=Clock.of_times(0.002, self.sampling_interval, self.equilibration, self.duration),
            species=(Species("right", number, 1.0, 0.5), Species("left", number, 1.0, 0.5)),
            placement=Lattice(),
            interactions=tuple(Interaction(*pair, repulsion) for pair in pairs),
            drives=(
                Drive("right", self.field, (1, 0, 0), variable="field"),
                Drive("left", self.field, (-1, 0, 0), variable="field"),
            ),
            outputs=(TRAJECTORY, PARTICLE_AVERAGES),
            measures=("particle_averages",),
        )
