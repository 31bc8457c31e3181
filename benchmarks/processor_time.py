"""What simulated time costs in processor time, so that what else the machine does counts little."""

import time

from lammps_inputs import Scene
from srd_driver import Simulation


def endless(scene: Scene, engine: str) -> Simulation:
    """The scene in a temporary run directory, one sampling interval done, without checkpoints."""
    simulation = Simulation(
        scene.model_copy(update={"duration": 1e9}), engine, checkpoint_interval=1e6
    )
    simulation.run(interval(scene))
    return simulation


def interval(scene: Scene) -> float:
    """Time between two outputs [t0]."""
    return scene.system.clock.sample_steps * scene.system.clock.time_step


def cost(simulation: Simulation, at_least: float) -> float:
    """Processor seconds for a time unit, from a piece of at least so many processor seconds."""
    piece, began, start = interval(simulation.scene), time.process_time(), simulation.time
    while (spent := time.process_time() - began) < at_least:
        simulation.run(piece)
        piece *= 2
    return spent / (simulation.time - start)
