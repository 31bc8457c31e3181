"""What tests ask of scenes of which they know the parts."""

from lammps_inputs import Scene
from lammps_inputs.system import Solvent


def solvent_of(scene: Scene) -> Solvent:
    """The fluid of a scene that has one."""
    assert scene.system.solvent is not None
    return scene.system.solvent
