"""`from narrows import ...`: what scripts and notebooks use."""

import sys
from multiprocessing.spawn import get_preparation_data
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import narrows
from analysis.sweep_table import main_program_hidden
from lammps_inputs import all_scenes
from narrows import RunDirectory, Simulation, make_scene, sweep, table
from srd_driver import RunError, progress_bar, sweep_definition
from tests.conftest import ROOT, Run

SHORT: dict[str, Any] = {
    "length": 20,
    "colloids": 1,
    "equilibration": 0.0,
    "sampling_interval": 0.15,
    "duration": 1.2,
}


def test_names_are_loaded_when_asked_for(command: Run) -> None:
    program = (
        "import sys, narrows\n"
        "print(sorted({'analysis', 'srd_driver', 'lammps_inputs', 'numpy'} & set(sys.modules)))\n"
        "print(narrows.Simulation.__module__, 'analysis' in sys.modules)\n"
    )
    assert command("python", "-c", program).stdout.splitlines() == [
        "[]",
        "srd_driver.simulation False",
    ]
    assert set(narrows.__all__) <= set(dir(narrows))
    assert all(getattr(narrows, name).__doc__ for name in narrows.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'simulation'"):
        _ = narrows.simulation


@pytest.mark.parametrize("words", [["analysis.py"], ["-m", "narrows", "--version"]])
def test_a_file_that_hides_ours_is_named(words: list[str], tmp_path: Path, command: Run) -> None:
    """A script that is itself called analysis.py, and one that lies beside."""
    (tmp_path / "analysis.py").write_text("import narrows\n")
    program = f"import runpy, sys; sys.path.insert(0, {str(tmp_path)!r}); sys.argv = {words!r}\n"
    program += "runpy.run_path('analysis.py')" if "-m" not in words else "import narrows"
    done = command("python", "-c", program, cwd=tmp_path, succeed=False)
    assert done.stderr.splitlines()[-1] == (
        f"ImportError: narrows needs its own package 'analysis', which {tmp_path / 'analysis.py'} "
        "hides: rename that file or folder, or start Python in another folder"
    )


def test_help_of_make_scene_lists_the_fields_of_every_scene() -> None:
    text = make_scene.__doc__ or ""
    for name, scene in all_scenes().items():
        assert f"\n{name}: " in text
        assert all(f"\n    {field} = " in text for field in scene.model_fields)


def test_the_fluid_of_a_running_simulation_is_that_of_the_reference() -> None:
    """At the start and after two collisions, and as many particles as fix srd has atoms."""
    scene = make_scene("channel", **SHORT)
    found = {}
    for engine in ("mpc", "reference", "srd"):
        with Simulation(scene, engine) as simulation:
            start = simulation.fluid()
            simulation.run(0.15)
            found[engine] = (start, simulation.fluid())
            assert simulation.fluid().positions.flags.writeable  # a copy: nobody is hurt
    for ours, theirs in zip(found["mpc"], found["reference"], strict=True):
        apart = scene.system.box.nearest_image(ours.positions - theirs.positions)
        np.testing.assert_allclose(apart, 0, atol=1e-9)
        np.testing.assert_allclose(ours.velocities, theirs.velocities, atol=1e-9)
    before, after = found["mpc"]
    assert np.abs(after.velocities - before.velocities).max() > 1
    assert len(found["srd"][1].positions) == scene.system.solvent.particles  # type: ignore[union-attr]
    np.testing.assert_allclose(found["srd"][0].positions, before.positions, atol=1e-6)


def test_every_process_has_the_whole_fluid(command: Run) -> None:
    program = (
        "from narrows import Simulation, make_scene\n"
        f"with Simulation(make_scene('channel', **{SHORT!r})) as simulation:\n"
        "    simulation.run(0.15)\n"
        "    fluid = simulation.fluid()\n"
        "    print(fluid.positions.shape, repr(fluid.velocities[:, 0].std().round(9)))\n"
    )
    first, second = command("mpirun", "-np", "2", "python", "-c", program).stdout.splitlines()
    assert first == second
    with Simulation(make_scene("channel", **SHORT), "reference") as simulation:
        simulation.run(0.15)
        fluid = simulation.fluid()
    assert first == f"{fluid.positions.shape} {fluid.velocities[:, 0].std().round(9)!r}"


def test_a_fluid_goes_on_after_a_resume(tmp_path: Path) -> None:
    scene = make_scene("channel", **SHORT)
    with Simulation(scene, directory=tmp_path) as simulation:
        simulation.run(0.6)
        simulation.checkpoint()
        before = simulation.fluid()
    with Simulation(scene, directory=tmp_path, resume=True) as simulation:
        np.testing.assert_array_equal(simulation.fluid().positions, before.positions)


def test_lammps_of_a_running_simulation() -> None:
    scene = make_scene("channel", **{**SHORT, "colloids": 2})
    with Simulation(scene) as simulation:
        assert simulation.lammps.get_natoms() == 2
        simulation.run(0.15)
        assert simulation.colloid_velocities.any()
        simulation.lammps.command("velocity colloids set 0 0 NULL")
        assert not simulation.colloid_velocities.any()
    with (
        Simulation(scene, "reference") as simulation,
        pytest.raises(RunError, match="engine reference: is none of LAMMPS"),
    ):
        _ = simulation.lammps
    with (
        Simulation(make_scene("lanes", duration=0.02, rest=0, particles=30)) as dry,
        pytest.raises(RunError, match="scene lanes: has no fluid"),
    ):
        dry.fluid()


def test_finish_with_progress(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with Simulation(make_scene("channel", **SHORT), "reference") as simulation:
        simulation.run(0.3, progress=True)
        assert capsys.readouterr().err == ""  # too soon for a line
        monkeypatch.setattr(progress_bar, "LINE_SECONDS", 0.0)
        seen: list[float] = []
        simulation.finish(lambda now: seen.append(now.time), progress=True)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == len(seen) > 0
    assert lines[-1].startswith("1 of 1 t0, ")
    assert " t0/s, moving at " in lines[-1]


def test_a_sweep_and_its_table(tmp_path: Path) -> None:
    """Its runs are done here; tests/narrows/test_notebooks.py starts them."""
    over = {"gravity": [0.1, 0.2]}
    plan = sweep_definition.plan(tmp_path / "s", "channel", SHORT, over, 1)
    sweep_definition.store(plan)
    for run in plan.runs:
        with Simulation(run.scene, run.engine, run.folder) as simulation:
            simulation.finish()
    found = sweep("channel", over, tmp_path / "s", jobs=1, **SHORT)
    np.testing.assert_array_equal(found["gravity"], [0.1, 0.2])
    assert (found["temperature_error"] > 0).all()
    again = table(tmp_path / "s")
    np.testing.assert_array_equal(again["temperature"], found["temperature"])
    assert again.fields == ("gravity",)
    assert "settling_speed" in again.quantities
    assert np.isnan(again["diffusion"]).all()  # so short a run does not tell it
    with pytest.raises(KeyError, match="speed: there is gravity, repeats, temperature, "):
        again["speed"]
    frame = pytest.importorskip("pandas").DataFrame(found.rows)
    assert found.dataframe().equals(frame)
    assert list(frame["repeats"]) == [1, 1]


def test_a_script_needs_no_main_guard(monkeypatch: pytest.MonkeyPatch) -> None:
    """The processes that analyse a sweep would otherwise run the script again, and again."""
    monkeypatch.setattr(sys.modules["__main__"], "__file__", __file__, raising=False)

    def run_again() -> list[str]:
        prepared: dict[str, Any] = get_preparation_data("analysis")
        return [name for name in prepared if name.startswith("init_main_from")]

    before = run_again()
    assert before
    with main_program_hidden():
        assert run_again() == []
    assert run_again() == before


def test_failed_runs_of_a_sweep_are_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="point width=3: width = 3"):
        sweep("channel", {"width": [3]}, tmp_path / "s", **SHORT)
    assert not (tmp_path / "s").exists()


def test_the_universe_has_radii(tmp_path: Path) -> None:
    scene = make_scene("channel", **{**SHORT, "colloid_radius": 1.5})
    with Simulation(scene, "reference", tmp_path) as simulation:
        simulation.run(0.15)
    np.testing.assert_allclose(RunDirectory(tmp_path).universe().atoms.radii, [1.5])


def test_ours_are_found_beside_narrows() -> None:
    """The check that names a hidden package looks where ours are."""
    assert Path(narrows.__file__).parent.parent == ROOT or sys.prefix in narrows.__file__
