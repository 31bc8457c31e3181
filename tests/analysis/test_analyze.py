"""A run directory through all measures of its manifest, against what was written into it."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from analysis import RunDirectoryError, analyze
from analysis.analyze import estimates
from analysis.measures import may_find
from run_files.manifest import read_manifest
from tests.analysis import run_writer
from tests.analysis.run_writer import (
    half_cells,
    slit,
    write_channel,
    write_manifest,
    write_observables,
    write_profile,
)
from tests.conftest import ROOT

PNG = b"\x89PNG"


def analyzed(path: Path) -> dict[str, Any]:
    """Runs the analysis; what it returns is what it wrote, strict JSON, and the figures exist."""
    summary = analyze(path)

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    assert json.loads((path / "summary.json").read_text(), parse_constant=refuse) == summary
    declared = read_manifest(path).system.measures
    assert [name for name in estimates(summary) if not may_find(declared, name)] == []
    assert not [file for file in path.iterdir() if file.name.startswith(".")]  # drafts
    assert summary["figures"] == sorted(file.name for file in path.glob("*.png"))
    assert all((path / name).read_bytes().startswith(PNG) for name in summary["figures"])
    return summary


def poiseuille(
    path: Path,
    intervals: int = 1000,
    gravity: float = 0.01,
    v_max: float = 0.25,
    v_wall: float = 0.05,
    noise: float = 0.02,
) -> None:
    """A parabola with noise; another one, twice as fast, during the equilibration."""
    y = half_cells(10.0)
    exact = [
        quad(lambda s: v_wall + (v_max - v_wall) * 4 * s * (10 - s) / 100, c - 0.25, c + 0.25)[0]
        / 0.5
        for c in y
    ]
    random = np.random.default_rng(1)
    velocity = exact + noise * random.normal(size=(intervals, len(y)))
    velocity[:5] *= 2
    write_manifest(path, "poiseuille", slit(gravity))
    write_profile(path, y, np.full_like(velocity, 200.0), velocity)
    temperature = 1 + 0.01 * random.normal(size=intervals)
    temperature[:5] = 9.0
    write_observables(path, temperature, velocity.mean(axis=1))


def close(entry: dict[str, Any], expected: float) -> bool:
    """Within four errors, and the error is below an eighth of the value."""
    value, error = entry["value"], entry["error"]
    return bool(abs(value - expected) < 4 * error < 0.5 * abs(expected))


def test_poiseuille(tmp_path: Path) -> None:
    poiseuille(tmp_path)
    summary = analyzed(tmp_path)
    assert summary["scene"] == "poiseuille"
    assert summary["engine"] == "srd"
    assert summary["simulated_time"] == pytest.approx(1000.0)
    assert summary["sampled_time"] == pytest.approx(995.0)
    assert summary["frames"] == 995
    assert summary["wall_seconds"] is None
    assert summary["fluid_particles"] == 4000
    assert summary["colloids"] == 0
    assert not summary["finished"]
    assert close(summary["temperature"], 1.0)
    assert close(summary["maximum_velocity"], 0.25)
    assert close(summary["viscosity"], 0.01 * 100 / (8 * 0.25))
    assert summary["viscosity"]["theory"] == 0.75
    assert close(summary["viscosity_curvature"], 0.01 * 100 / (8 * 0.20))
    assert close(summary["wall_slip"], 20.0)
    mean = 0.05 + 0.2 * 2 / 3
    assert close(summary["fluid_velocity"], mean)
    assert close(summary["reynolds_number"], mean * 10 / summary["viscosity"]["theory"])
    assert summary["figures"] == ["profile.png"]


def test_flow_to_the_left_has_the_same_viscosity(tmp_path: Path) -> None:
    poiseuille(tmp_path, gravity=-0.01, v_max=-0.25, v_wall=-0.05)
    summary = analyzed(tmp_path)
    assert summary["viscosity"]["value"] == pytest.approx(0.5, rel=0.01)
    assert summary["viscosity"]["error"] > 0


@pytest.mark.parametrize(
    ("gravity", "reason"), [(0.0, "no gravity"), (-0.01, "the fluid does not flow along gravity")]
)
def test_no_viscosity(tmp_path: Path, gravity: float, reason: str) -> None:
    poiseuille(tmp_path, gravity=gravity)
    viscosity = analyzed(tmp_path)["viscosity"]
    assert viscosity["value"] is None
    assert viscosity["reason"] == reason
    assert viscosity["theory"] is not None


def test_short_run_has_lower_bounds_for_errors(tmp_path: Path) -> None:
    poiseuille(tmp_path, intervals=10)
    summary = analyzed(tmp_path)
    assert summary["viscosity"]["error"] > 0
    assert summary["viscosity"]["reason"] == "lower bound: run longer, 5 samples are too few"


def test_fluid_without_theory(tmp_path: Path) -> None:
    poiseuille(tmp_path)
    system = slit(gravity=0.01)
    system["solvent"]["viscosity_theory"] = None
    write_manifest(tmp_path, "poiseuille", system)
    summary = analyzed(tmp_path)
    assert summary["viscosity"]["theory"] is None
    assert summary["reynolds_number"]["value"] is None
    assert summary["reynolds_number"]["reason"].startswith("kinetic theory has no viscosity")


def bulk(path: Path, shear_wave: float = 0.1) -> None:
    y = half_cells(32.0)
    rate = 0.6 * (2 * math.pi / 32) ** 2
    times = np.arange(1, 201)
    random = np.random.default_rng(2)
    wave = 0.1 * np.exp(-rate * times)[:, None] * np.sin(2 * np.pi * y / 32)
    wave[:5] *= 2  # in the equilibration
    velocity = wave + 1e-4 * random.normal(size=wave.shape)
    write_manifest(path, "bulk", run_writer.bulk(shear_wave))
    write_profile(path, y, np.full_like(velocity, 160.0), velocity)
    write_observables(path, np.ones(200), np.zeros(200))


def test_shear_wave(tmp_path: Path) -> None:
    bulk(tmp_path)
    summary = analyzed(tmp_path)
    assert summary["viscosity"]["value"] == pytest.approx(0.6, rel=0.01)
    assert summary["viscosity"]["theory"] == 0.75
    assert "reynolds_number" not in summary
    assert summary["figures"] == ["shear_wave.png"]


def test_fluid_at_rest_has_no_viscosity(tmp_path: Path) -> None:
    bulk(tmp_path, shear_wave=0.0)
    summary = analyzed(tmp_path)
    assert "viscosity" not in summary
    assert summary["figures"] == []
    assert summary["temperature"] == {"value": 1.0, "error": 0.0}


def channel(path: Path, frames: int = 601, colloids: int = 7, mass: float = 100.0) -> None:
    """Random walkers with a drift of 0.03 in a fluid whose whole moves at 0.01; a zigzag of 0.2."""
    random = np.random.default_rng(3)
    times = np.arange(frames)[:, None]
    start = 5.0 * (np.arange(colloids) + 0.5)
    start[-1] += 2.0
    x = start + 0.03 * times + np.cumsum(0.02 * random.normal(size=(frames, colloids)), axis=0)
    x[5:] += 3.0  # a jump within the equilibration does not count
    y = 5 + 0.2 * (-1.0) ** np.arange(colloids) + 0.01 * random.normal(size=(frames, colloids))
    velocities = [0.03, 0.0] + random.normal(size=(frames, colloids, 2)) / math.sqrt(mass)
    mean_velocity = 0.01 + 0.001 * random.normal(size=frames - 1)
    write_channel(path, np.stack([x, y], axis=2), velocities, mean_velocity, total_steps=6000)


def test_channel(tmp_path: Path) -> None:
    channel(tmp_path)
    summary = analyzed(tmp_path)
    assert summary["finished"]
    assert summary["frames"] == 595
    assert close(summary["settling_speed_rest"], 0.03)
    assert close(summary["settling_speed"], 0.02)
    assert close(summary["colloid_temperature"], 1.0)
    diffusion = summary["diffusion"]
    assert abs(diffusion["value"] - 0.02**2 / 2) < 4 * diffusion["error"]
    assert not diffusion["subdiffusive"]
    zigzag = summary["zigzag"]
    assert zigzag["amplitude_rms"]["value"] == pytest.approx(0.2, rel=0.01)
    assert zigzag["amplitude_rms"]["error"] == pytest.approx(0.01 / math.sqrt(7 * 595), rel=0.4)
    assert zigzag["displacement_rms"] == pytest.approx(0.2, rel=0.01)
    assert zigzag["uncorrelated_rms"] == pytest.approx(0.2 / math.sqrt(7), rel=0.01)
    assert zigzag["local_rms"] == pytest.approx([0.2] * 5, rel=0.01)
    spacings = summary["spacings"]
    # each walks by 0.02 sqrt(2 * 600) = 0.7 at most against its neighbour, head first
    assert spacings["neighbours"] == pytest.approx([7.0, 5.0, 5.0, 5.0, 5.0, 5.0], abs=1.9)
    assert spacings["neighbours"][0] == max(spacings["neighbours"])
    assert len(spacings["groups"]) == 1
    assert spacings["groups_initial"] == pytest.approx([(7.0 + 4 * 5.0) / 5], abs=0.05)
    assert spacings["left_out_at_tail"] == 1
    assert summary["pair_correlation"]["bin_width"] == pytest.approx(0.1)
    assert summary["warnings"] == []
    assert summary["figures"] == [
        "diffusion.png",  # g(x) of walks so slow is noise
        "profile.png",
        "settling_speed.png",
        "snapshot.png",
        "space_time.png",
        "spacings.png",
        "zigzag.png",
    ]


def test_a_run_that_went_wrong_says_so(tmp_path: Path) -> None:
    """Colloids twice as hot as the fluid, two of them 1 apart in one frame."""
    channel(tmp_path, mass=50.0)
    trajectory = tmp_path / "trajectory.lammpsdump"
    text = trajectory.read_text().splitlines()
    last = next(n for n in range(len(text) - 1, 0, -1) if text[n].startswith("2 1 "))
    first = text[last - 1].split()
    text[last] = " ".join(["2", "1", str(float(first[2]) + 1.0), *first[3:]])
    trajectory.write_text("\n".join(text) + "\n")
    hot, overlapping = analyzed(tmp_path)["warnings"]
    assert hot.startswith("the temperature of the colloids is")
    assert overlapping.startswith("two colloids came within 1 of each other")


def test_single_colloid_has_no_chain(tmp_path: Path) -> None:
    channel(tmp_path, frames=101, colloids=1)
    summary = analyzed(tmp_path)
    assert not {"spacings", "zigzag", "pair_correlation"} & summary.keys()
    assert summary["diffusion"] == {
        "value": None,
        "error": None,
        "reason": "run longer, at least 320 t0: 96 frames; at least 320 are needed",
    }
    assert close(summary["settling_speed"], 0.02)
    assert summary["figures"] == [
        "profile.png",
        "settling_speed.png",
        "snapshot.png",
        "space_time.png",
    ]


def test_two_colloids_have_a_spacing_and_no_zigzag(tmp_path: Path) -> None:
    channel(tmp_path, frames=101, colloids=2)
    summary = analyzed(tmp_path)
    assert summary["spacings"]["groups"] == []
    assert len(summary["spacings"]["neighbours"]) == 1
    assert "zigzag" not in summary


def test_run_in_progress_uses_what_both_files_hold(tmp_path: Path) -> None:
    channel(tmp_path)
    file = tmp_path / "observables.dat"
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:-1]))
    summary = analyzed(tmp_path)
    assert not summary["finished"]
    assert summary["simulated_time"] == pytest.approx(599.0)
    assert close(summary["settling_speed"], 0.02)


def test_analysis_can_be_repeated(tmp_path: Path) -> None:
    channel(tmp_path, frames=101)
    assert analyze(str(tmp_path)) == analyze(tmp_path)


def test_nothing_after_the_equilibration(tmp_path: Path) -> None:
    poiseuille(tmp_path, intervals=5)
    with pytest.raises(RunDirectoryError) as error:
        analyze(tmp_path)
    assert str(error.value) == (
        f"{tmp_path}: no frames after the equilibration: it ends at step 50, the output at step 50"
    )
    assert not (tmp_path / "summary.json").exists()


def test_trajectory_ends_in_the_equilibration(tmp_path: Path) -> None:
    channel(tmp_path, frames=7)
    file = tmp_path / "trajectory.lammpsdump"
    file.write_text("".join(file.read_text().splitlines(keepends=True)[: 6 * (9 + 7)]))
    with pytest.raises(RunDirectoryError) as error:
        analyze(tmp_path)
    assert str(error.value) == (
        f"{file}: no two frames after the equilibration: it ends at step 50, the trajectory at "
        "step 50"
    )


def test_mass_of_a_colloid_that_is_none(tmp_path: Path) -> None:
    channel(tmp_path, frames=101)
    system = run_writer.channel(7)
    system["species"][0]["mass"] = None
    write_manifest(tmp_path, "channel", system)
    with pytest.raises(RunDirectoryError, match=r"system\.species\.0\.mass: should be a valid num"):
        analyze(tmp_path)


def test_slit_with_too_few_bins_for_a_parabola(tmp_path: Path) -> None:
    poiseuille(tmp_path, intervals=20)
    y = np.array([2.5, 7.5])
    write_profile(tmp_path, y, np.ones((20, 2)), np.ones((20, 2)))
    with pytest.raises(RunDirectoryError, match=r"fluid_profile.dat: fewer than 3 bins hold fluid"):
        analyze(tmp_path)


def test_a_manifest_may_name_other_measures(tmp_path: Path) -> None:
    channel(tmp_path, frames=101)
    write_manifest(tmp_path, "mine", run_writer.channel(7) | {"measures": ["spacings"]})
    summary = analyzed(tmp_path)
    assert summary["scene"] == "mine"
    assert "spacings" in summary
    assert not {"temperature", "settling_speed", "zigzag"} & summary.keys()
    assert summary["figures"] == ["spacings.png"]


def test_an_unknown_measure_is_named(tmp_path: Path) -> None:
    channel(tmp_path, frames=101)
    write_manifest(tmp_path, "channel", run_writer.channel(7) | {"measures": ["colour"]})
    with pytest.raises(RunDirectoryError) as error:
        analyze(tmp_path)
    assert str(error.value).startswith(
        f"{tmp_path / 'manifest.json'}: measure colour: must be one of bond_order, "
    )
    assert not (tmp_path / "summary.json").exists()


def test_a_measure_names_the_part_that_it_misses(tmp_path: Path) -> None:
    channel(tmp_path, frames=101, colloids=2)
    two = {"name": "others", "count": 1, "mass": 1.0, "radius": 1.0}
    one = {"name": "colloids", "count": 1, "mass": 1.0, "radius": 1.0}
    mixed = run_writer.channel(2) | {"species": [one, two], "measures": ["colloid_temperature"]}
    for system, complaint in (
        (mixed, "one species is needed; there is colloids, others"),
        (
            slit(0.1) | {"solvent": None, "measures": ["slit_flow"]},
            "the scene channel has no fluid",
        ),
    ):
        write_manifest(tmp_path, "channel", system)
        with pytest.raises(RunDirectoryError) as error:
            analyze(tmp_path)
        assert str(error.value) == f"{tmp_path}: {complaint}"


def test_a_run_of_narrows_0_1_is_analysed_alike(tmp_path: Path) -> None:
    channel(tmp_path)
    summary = analyzed(tmp_path)
    old = json.loads((ROOT / "tests" / "run_files" / "manifests_of_0_1.json").read_text())[0]
    old |= {"engine": "srd", "colloids": 7, "colloid_mass": 100.0, "fluid_particles": 4000}
    old |= {"time_step": 0.1, "steps_per_collision": 1, "sample_steps": 10, "fluid_looks": 1}
    old |= {"equilibration_steps": 50, "total_steps": 6000, "viscosity_theory": 0.75}
    (tmp_path / "manifest.json").write_text(json.dumps(old))
    assert analyzed(tmp_path) == summary


def test_particles_without_a_fluid(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    temperature = 1 + 0.01 * random.normal(size=200)
    temperature[:5] = 9.0  # in the equilibration
    columns = {"temperature": temperature, "potential_energy": 3 + 0 * temperature}
    table = run_writer.AVERAGES | {"columns": list(columns)}
    system = run_writer.channel(3) | {"solvent": None, "drives": [], "outputs": [table]}
    write_manifest(tmp_path, "gas", system | {"measures": ["particle_averages"]})
    rows = [f"{10 * n} {t:.10g} 3" for n, t in enumerate(temperature, start=1)]
    title = "# TimeStep v_temperature v_potential_energy"
    (tmp_path / "observables.dat").write_text("\n".join([title, *rows, ""]))
    summary = analyzed(tmp_path)
    assert close(summary["temperature"], 1.0)
    assert summary["potential_energy"] == {"value": 3.0, "error": 0.0}
    assert (summary["fluid_particles"], summary["colloids"], summary["figures"]) == (0, 3, [])
