"""Forces between species and fluid at every MD step: what engines mpc and reference ask of them."""

import math
from collections.abc import Iterator

from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import FLUID, System

LONGEST_STEP = 0.032  # in sigma sqrt(mu): at 0.030 temperatures hold, at 0.0375 runs break


def force_problems(system: System) -> Iterator[str]:
    """What the forces do not allow, one line each.

    A thermal collision takes about sigma sqrt(mu) / 6, mu the reduced mass of colloid and particle.
    """
    for interaction in system.interactions:
        if interaction.second == FLUID and not (
            isinstance(interaction.potential, RepulsiveMie) and interaction.potential.exponent == 6
        ):
            yield (
                f"{interaction.potential!r} between {interaction.first} and the fluid: must be a "
                "12-6 repulsion"
            )
    fluid = system.fluid_interactions()
    if fluid and system.solvent and system.solvent.coupling != "force":
        yield f"coupling = {system.solvent.coupling!r}: there is no force between species and fluid"
    for species in system.species:
        potential = fluid.get(species.name)
        if not isinstance(potential, RepulsiveMie) or system.solvent is None:
            continue
        longest = LONGEST_STEP * potential.sigma * math.sqrt(species.mass / (1 + species.mass))
        step = system.clock.time_step
        if step > longest:
            yield (
                f"md_steps_per_collision = {system.clock.steps_per_collision!r}: steps of "
                f"{step:.4g} let fluid fly into the {species.name}; at most {longest:.2g}, which "
                f"takes {math.ceil(system.solvent.collision_time / longest)} steps"
            )
