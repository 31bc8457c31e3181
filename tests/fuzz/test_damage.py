"""Any damage to a run directory, sweep, scene or lattice: one line, or the right numbers.

By default a few cases; `pytest -m fuzz` takes as many as NARROWS_FUZZ_CASES says, 3000 if it does
not, and a seed of its own each time.
"""

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from analysis import RunDirectory
from lammps_inputs import Scene, SceneError, all_engines, all_scenes, make_scene
from lammps_inputs.deck import check_engine
from lammps_inputs.manifest import manifest
from lammps_inputs.scene import read_scene
from narrows.cli import app
from run_files import RunDirectoryError
from srd_driver import RunError, Simulation, sweep_definition
from srd_driver.resume import stored_fields
from srd_driver.status import status_of, stored_run
from tests.fuzz.damage import JSON_VALUES, Damage, damages

CASES = int(os.environ.get("NARROWS_FUZZ_CASES", "3000"))
SHORT: dict[str, Any] = {
    "length": 12,
    "width": 7,
    "density": 3,
    "colloids": 1,
    "colloid_radius": 1.0,
    "wall_sigma": 1.0,
    "collision_time": 0.1,
    "md_steps_per_collision": 20,
    "equilibration": 0,
    "duration": 2.0,
    "sampling_interval": 0.2,
}
SPHERES: dict[str, Any] = {
    "particles": 60,
    "packing_fraction": 0.2,
    "reaction_probabilities": [0.1, 1.0],
    "trajectory": True,
    "equilibration": 0,
    "duration": 2.0,
    "sampling_interval": 0.2,
}
EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "lattice" / "internal_state.toml"


def cases(count: int, **options: Any) -> Callable[[Any], Any]:
    return settings(
        max_examples=count,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
        **options,
    )


quick = cases(25, derandomize=True)
few = cases(8, derandomize=True)
long = cases(CASES, print_blob=True)


def numbers_of_a_channel(run: RunDirectory) -> list[Any]:
    """All that measures ask of a run."""
    table, profile = run.table(), run.profile()
    return [
        *(table.steps, *table.columns.values()),
        *(profile.steps, profile.y, profile.counts, profile.velocity_x),
        *(np.array(run.times(table.steps)), run.acceleration("colloids")),
        *(np.array(run.sampled(table.steps)), np.array([run.length, run.width])),
    ]


def numbers_of_spheres(run: RunDirectory) -> list[Any]:
    """Likewise, of colours too."""
    found: list[Any] = []
    for name in ("observables", "reactions"):
        table = run.table(name)
        found += [table.steps, *table.columns.values()]
    for name in ("colors", "speeds"):
        bins = run.bins(name)
        found += [bins.steps, bins.positions, bins["chances_1"], bins["labels_2"]]
    return found


@dataclass(frozen=True)
class Kind:
    """Runs of one engine.

    Attributes:
        scene, fields, engine: what runs.
        outputs: its files.
        numbers: that measures ask of it.
        checkpoints: half way, and at the end.
    """

    scene: str
    fields: dict[str, Any]
    engine: str
    outputs: tuple[str, ...]
    numbers: Callable[[RunDirectory], list[Any]]
    checkpoints: tuple[str, str]

    def make(self, seed: int = 1) -> Scene:
        return make_scene(self.scene, seed=seed, **self.fields)

    def files(self, half_way: bool) -> list[str]:
        checkpoint = self.checkpoints[0 if half_way else 1]
        return [*self.outputs, "manifest.json", "progress.json", "scene.toml", checkpoint]

    def read(self, directory: Path) -> list[Any]:
        run = RunDirectory(directory)
        particles = run.particles()
        return [
            *self.numbers(run),
            *(particles.steps, particles.positions, particles.velocities),
            np.array([each.mass for each in run.manifest.system.species]),
        ]


CHANNEL = Kind(
    "channel",
    SHORT,
    "reference",
    ("trajectory.lammpsdump", "observables.dat", "fluid_profile.dat"),
    numbers_of_a_channel,
    ("checkpoint.160.npz", "checkpoint.400.npz"),
)
PORE = Kind(
    "pore",
    SPHERES,
    "events",
    ("trajectory.lammpsdump", "observables.dat", "colors.dat", "reactions.dat", "speeds.dat"),
    numbers_of_spheres,
    ("checkpoint.8.npz", "checkpoint.20.npz"),
)


class Runs:
    """A finished run, one half way, and the same of another seed."""

    def __init__(self, kind: Kind, folder: Path) -> None:
        self.kind = kind
        self.finished, self.half_way = folder / "finished", folder / "half_way"
        self.others = {self.finished: folder / "finished2", self.half_way: folder / "half_way2"}
        for seed, (finished, half_way) in enumerate(
            ((self.finished, self.half_way), tuple(self.others.values())), start=1
        ):
            with Simulation(kind.make(seed), kind.engine, finished) as run:
                run.finish()
            with Simulation(kind.make(seed), kind.engine, half_way, False, 0.4) as run:
                run.run(0.8)
        self.numbers = kind.read(self.finished)
        self.outputs = [(self.finished / name).read_bytes() for name in kind.outputs]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(CHANNEL, tmp_path_factory.mktemp("runs"))


@pytest.fixture(scope="module")
def spheres(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(PORE, tmp_path_factory.mktemp("spheres"))


def one_line(error: Exception) -> None:
    text = str(error)
    assert text.strip()
    assert "\n" not in text
    assert len(text) < 3000


def files(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir() if path.name != ".lock")


def unchanged_by_hand(directory: Path) -> bool:
    """Whether no manifest or progress without a digest, as somebody writes it, is there."""
    for name in ("manifest.json", "progress.json"):
        file = directory / name
        if file.exists() and '"digest"' not in file.read_text(errors="replace"):
            return False
    return (directory / "progress.json").exists()


def check_damaged(start: Path, damage: Damage, runs: Runs) -> None:
    """Resume, status and analysis of a damaged copy."""
    with tempfile.TemporaryDirectory() as folder:
        directory = Path(folder) / "run"
        shutil.copytree(start, directory)
        damage(directory, runs.others[start])
        try:
            status_of(stored_run(directory))
        except (RunError, RunDirectoryError, SceneError) as error:
            one_line(error)
        try:
            found = runs.kind.read(directory)
        except RunDirectoryError as error:
            one_line(error)
        else:
            if unchanged_by_hand(directory) and start == runs.finished:
                for now, before in zip(found, runs.numbers, strict=True):
                    np.testing.assert_array_equal(now, before)
        try:
            fields = stored_fields(directory)
            again = make_scene(str(fields.pop("scene")), **fields)
            small = again.system.work < 1e6
            if small:
                with Simulation(again, runs.kind.engine, directory, resume=True) as run:
                    run.finish()
        except (RunError, RunDirectoryError, SceneError) as error:
            one_line(error)
        else:
            if small and start == runs.half_way and unchanged_by_hand(directory):
                assert [
                    (directory / name).read_bytes() for name in runs.kind.outputs
                ] == runs.outputs


def test_the_files_of_a_run_are_known(runs: Runs, spheres: Runs) -> None:
    for each in (runs, spheres):
        assert files(each.half_way) == sorted(each.kind.files(True))
        assert files(each.finished) == sorted(each.kind.files(False))


@quick
@given(damage=damages(CHANNEL.files(True)))
def test_a_damaged_half_way_run(damage: Damage, runs: Runs) -> None:
    check_damaged(runs.half_way, damage, runs)


@quick
@given(damage=damages(CHANNEL.files(False)))
def test_a_damaged_finished_run(damage: Damage, runs: Runs) -> None:
    check_damaged(runs.finished, damage, runs)


@few
@given(damage=damages(PORE.files(True)))
def test_a_damaged_half_way_run_of_spheres(damage: Damage, spheres: Runs) -> None:
    check_damaged(spheres.half_way, damage, spheres)


@few
@given(damage=damages(PORE.files(False)))
def test_a_damaged_finished_run_of_spheres(damage: Damage, spheres: Runs) -> None:
    check_damaged(spheres.finished, damage, spheres)


@pytest.mark.fuzz
@long
@given(damage=damages(CHANNEL.files(True)))
def test_many_damaged_half_way_runs(damage: Damage, runs: Runs) -> None:
    check_damaged(runs.half_way, damage, runs)


@pytest.mark.fuzz
@long
@given(damage=damages(CHANNEL.files(False)))
def test_many_damaged_finished_runs(damage: Damage, runs: Runs) -> None:
    check_damaged(runs.finished, damage, runs)


@pytest.mark.fuzz
@long
@given(damage=damages(PORE.files(True)))
def test_many_damaged_half_way_runs_of_spheres(damage: Damage, spheres: Runs) -> None:
    check_damaged(spheres.half_way, damage, spheres)


@pytest.mark.fuzz
@long
@given(damage=damages(PORE.files(False)))
def test_many_damaged_finished_runs_of_spheres(damage: Damage, spheres: Runs) -> None:
    check_damaged(spheres.finished, damage, spheres)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("sweeps")
    for name, gravity in (("one", [0.1, 0.2]), ("other", [0.3])):
        plan = sweep_definition.plan(
            folder / name, "channel", SHORT, {"gravity": gravity}, 2, "reference"
        )
        sweep_definition.store(plan)
    return folder / "one", folder / "other"


def check_sweep(damage: Damage, swept: tuple[Path, Path]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        directory = Path(folder) / "sweep"
        shutil.copytree(swept[0], directory)
        damage(directory, swept[1])
        before = sorted(Path(folder).rglob("*"))
        try:
            sweep = sweep_definition.read(directory)
            assert all(run.folder.parent == directory for run in sweep.runs)
        except (RunError, RunDirectoryError) as error:
            one_line(error)
        assert sorted(Path(folder).rglob("*")) == before


@quick
@given(damage=damages(["sweep.json"]))
def test_a_damaged_sweep(damage: Damage, swept: tuple[Path, Path]) -> None:
    check_sweep(damage, swept)


@pytest.mark.fuzz
@long
@given(damage=damages(["sweep.json"]))
def test_many_damaged_sweeps(damage: Damage, swept: tuple[Path, Path]) -> None:
    check_sweep(damage, swept)


def scene_files() -> st.SearchStrategy[tuple[str, dict[str, Any]]]:
    return st.sampled_from(sorted(all_scenes())).flatmap(
        lambda name: st.tuples(
            st.just(name),
            st.dictionaries(
                st.sampled_from([*all_scenes()[name].model_fields, "name", "nonesuch"]),
                JSON_VALUES,
                max_size=4,
            ),
        )
    )


def check_scene(given_: tuple[str, dict[str, Any]]) -> None:
    name, fields = given_
    try:
        made = make_scene(name, **fields)
        for engine in all_engines():
            try:
                check_engine(made, engine)
            except SceneError as error:
                for problem in error.problems:
                    one_line(SceneError([problem]))
            else:
                json.dumps(manifest(made, engine), allow_nan=False)
    except SceneError as error:
        for problem in error.problems:
            one_line(SceneError([problem]))


@cases(60, derandomize=True)
@given(given_=scene_files())
def test_a_scene_of_any_values(given_: tuple[str, dict[str, Any]]) -> None:
    check_scene(given_)


@pytest.mark.fuzz
@long
@given(given_=scene_files())
def test_many_scenes_of_any_values(given_: tuple[str, dict[str, Any]]) -> None:
    check_scene(given_)


def check_text_files(data: bytes, a: float, b: float) -> None:
    """A scene file and a lattice file that are not what they should be."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "file.toml"
        example = EXAMPLE.read_bytes()
        low, high = sorted((int(a * len(example)), int(b * len(example))))
        file.write_bytes(example[:low] + data + example[high:])
        try:
            fields = read_scene(file)
            fields.pop("scene", None)
            make_scene("channel", **fields)
        except SceneError as error:
            for problem in error.problems:
                one_line(SceneError([problem]))
        done = CliRunner().invoke(app, ["lattice", "check", str(file), "--sites", "3"])
        assert done.exit_code in (0, 2)
        assert done.exception is None or isinstance(done.exception, SystemExit)
        if done.exit_code:
            assert done.stderr.startswith("narrows lattice: ")


ANYTHING = st.one_of(
    st.binary(max_size=60),
    st.text(max_size=60).map(str.encode),
    st.sampled_from([b"[" * 5000, b"a = " + b"[" * 5000, b"1e999", b"-1", b"1e300", b"nan"]),
)


@quick
@given(data=ANYTHING, a=st.floats(0, 1), b=st.floats(0, 1))
def test_a_damaged_scene_or_lattice_file(data: bytes, a: float, b: float) -> None:
    check_text_files(data, a, b)


@pytest.mark.fuzz
@long
@given(data=ANYTHING, a=st.floats(0, 1), b=st.floats(0, 1))
def test_many_damaged_scene_or_lattice_files(data: bytes, a: float, b: float) -> None:
    check_text_files(data, a, b)
