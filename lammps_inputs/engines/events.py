"""Hard spheres from event to event, `srd_driver/events`: it writes no deck."""

from collections.abc import Iterator
from typing import ClassVar

from lammps_inputs.color_outputs import SLIT_EVENT_AVERAGES, color_outputs
from lammps_inputs.engines.engine import Engine
from lammps_inputs.system import SIZES, TRAJECTORY, Events, System

SHORTEST = 4  # diameters along a periodic axis: of particles in neighbouring cells, the nearest
# images must be those in these cells


class EventDriven(Engine):
    """Equal hard spheres of mass 1 between hard walls or in a periodic box, and their colours."""

    name: ClassVar[str] = "events"
    processes = False
    pair_potentials = ()
    wall_potentials = ()
    motions = (Events,)
    reactions = True

    def problems(self, system: System) -> Iterator[str]:
        if system.solvent:
            yield f"engine = {self.name!r}: it has no fluid, and the scene needs one"
        yield from self.unknown_parts(system)
        kinds = {(species.mass, species.radius > 0) for species in system.species}
        if len(system.species) != 1 or kinds != {(1.0, True)}:
            yield f"engine = {self.name!r}: it needs one species, of mass 1 and with a radius"
            return
        for drive in system.drives:
            yield f"{drive!r}: engine {self.name} has no drives"
        diameter = 2 * system.species[0].radius
        for axis, (size, periodic) in enumerate(
            zip(system.box.sizes, system.box.periodic, strict=True)
        ):
            sides = sorted(wall.side for wall in system.walls_on(axis))
            if sides != ([] if periodic else ["lower", "upper"]):
                yield f"walls across the {SIZES[axis]}: one on either side, or a periodic axis"
            if periodic and size < SHORTEST * diameter:
                yield (
                    f"{SIZES[axis]} = {size:g}: engine {self.name} needs {SHORTEST} diameters "
                    "along a periodic axis"
                )
        yield from self._unknown_outputs(system)

    def _unknown_outputs(self, system: System) -> Iterator[str]:
        reactions = system.reactions
        colors = color_outputs(len(reactions.probabilities)) if reactions else ()
        files = {output.file: output.columns for output in colors}
        files |= {each.file: each.columns for each in (TRAJECTORY, SLIT_EVENT_AVERAGES)}
        for output in system.outputs:
            unknown = [name for name in output.columns if name not in files.get(output.file, ())]
            if unknown:
                yield f"{output.file}: engine {self.name} does not tell {', '.join(unknown)}"


ENGINE = EventDriven()
