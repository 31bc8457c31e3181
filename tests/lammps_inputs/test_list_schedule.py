"""When LAMMPS builds neighbour lists and wraps places does not depend on checkpoints."""

import math
from pathlib import Path
from typing import ClassVar

import pytest

from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import script, write_deck
from lammps_inputs.placement import Lattice
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import (
    PARTICLE_AVERAGES,
    TRAJECTORY,
    Box,
    Clock,
    Interaction,
    Species,
    System,
)
from srd_driver import Simulation
from tests.conftest import Run

FILES = (TRAJECTORY.file, PARTICLE_AVERAGES.file)


class Gas(Scene):
    """Soft discs, close enough to meet often."""

    name: ClassVar[str] = "gas"

    duration: float = 40.0
    equilibration: float = 0.0

    def build(self) -> System:
        return System(
            box=Box((14.0, 14.0), periodic=(True, True)),
            clock=Clock.of_times(0.005, self.sampling_interval, self.equilibration, self.duration),
            species=(Species("discs", 120, 1.0, 0.5),),
            placement=Lattice(),
            interactions=(Interaction("discs", "discs", RepulsiveMie(1.0, 6)),),
            outputs=(TRAJECTORY, PARTICLE_AVERAGES),
            measures=(),
        )


def contents(directory: Path) -> list[bytes]:
    return [(directory / file).read_bytes() for file in FILES]


def test_checkpoints_and_stops_leave_no_trace_in_molecular_dynamics(
    tmp_path: Path, command: Run
) -> None:
    scene = Gas.make()
    (tmp_path / "lmp").mkdir()
    write_deck(scene, tmp_path / "lmp", "md")
    command("lmp", "-in", "in.lammps", cwd=tmp_path / "lmp")
    by_lmp = contents(tmp_path / "lmp")
    assert "Dangerous builds = 0" in (tmp_path / "lmp" / "log.lammps").read_text()

    for interval in (1.0, 7.0):
        with Simulation(scene, "md", tmp_path / str(interval), False, interval) as run:
            run.finish()
        assert contents(tmp_path / str(interval)) == by_lmp

    for end in (13.0, 29.0, scene.duration):
        with Simulation(scene, "md", tmp_path / "parts", True, 5.0) as run:
            run.run(end - run.time)
            run.stop()
    assert contents(tmp_path / "parts") == by_lmp


def test_the_skin_is_what_two_colloids_may_travel_between_lists() -> None:
    assert "neighbor 0.5 bin\n" in script(make_scene("channel"), "mpc")
    small = make_scene("channel", collision_time=0.1, md_steps_per_collision=20, colloid_radius=0.5)
    skin = 2 * 0.1 * (1 + 10 / math.sqrt(math.pi * 0.5**2 * 10))
    text = script(small, "mpc")
    assert f"neighbor {skin:.6g} bin\n" in text
    assert "neigh_modify delay 0 every 20 check no\n" in text


@pytest.mark.parametrize("name", ["poiseuille", "bulk"])
def test_a_fluid_alone_has_no_lists(name: str) -> None:
    assert "neigh" not in script(make_scene(name), "mpc")
