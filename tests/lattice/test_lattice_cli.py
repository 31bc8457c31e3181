"""`narrows lattice check|simulate|hydro` as a user runs them, and what they refuse."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from typer.testing import CliRunner, Result

from lattice import generator, shocks, spec
from lattice.models import charge_gas
from narrows.cli import app
from tests.lattice.lattice_paper import Case, boundary_rates, shock_charge, shock_internal

Data = dict[str, Any]
Change = Callable[[Data], object]

EXAMPLES = sorted((Path(__file__).parents[2] / "docs" / "examples" / "lattice").glob("*.toml"))
KEYS = {
    "stationarity_residual",
    "random_walk_residual",
    "closes_at_ends",
    "d1",
    "d2",
    "end_rates",
    "shock_velocity",
    "shock_diffusion",
    "currents",
    "densities",
    "stationary_profile",
}


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["lattice", *(str(a) for a in arguments)])


def contents(case: Case) -> Data:
    """FILE of a test case; the internal-state family with its 24 rates."""
    return {
        "family": case.gas.family,
        "z1": case.z1,
        "z2": case.z2,
        "rates": dict(case.w),
        "left": dict(case.left),
        "right": dict(case.right),
    }


def write(path: Path, data: Data) -> Path:
    if path.suffix == ".json":
        path.write_text(json.dumps(data))
    else:
        path.write_text(tomli_w.dumps(data))
    return path


def checked(path: Path, *extra: object) -> Data:
    out = path.with_name("out.json")
    result = run("check", path, "--sites", 5, "--json", out, *extra)
    assert result.exit_code == 0, result.output
    data: Data = json.loads(out.read_text())
    return data


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_examples_are_on_their_manifold(path: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    result = run("check", path, "--sites", 6, "--json", out)
    assert result.exit_code == 0, result.output
    data = json.loads(out.read_text())
    assert set(data) >= KEYS
    assert "mean_shock_position" not in data
    assert data["stationarity_residual"] < 1e-13
    assert data["random_walk_residual"] < 1e-13
    assert data["closes_at_ends"] is True
    assert data["shock_velocity"] == data["d2"] - data["d1"]
    assert data["shock_diffusion"] == (data["d2"] + data["d1"]) / 2


def test_four_examples_are_there() -> None:
    assert [p.stem for p in EXAMPLES] == ["asep", "internal_state", "one_sided", "two_sided"]


@pytest.mark.parametrize(
    "case",
    [
        shock_charge("one-sided"),
        shock_charge("two-sided"),
        shock_internal(),
    ],
    ids=["one-sided", "two-sided", "internal-state"],
)
@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_check_reports_the_closed_forms(case: Case, suffix: str, tmp_path: Path) -> None:
    data = checked(
        write(tmp_path / f"model{suffix}", contents(case)), "--from", 2, "--times", "0.5,2"
    )
    for currents in data["stationary_currents"].values():
        assert len(currents) == len(data["stationary_profile"]["rho_A"]) - 1
    # what is conserved flows alike over every bond
    flow = data["stationary_currents"]["C"]
    assert flow == pytest.approx([flow[0]] * len(flow), abs=1e-13)
    assert len(data["domain_wall_profile"]) == len(data["stationary_profile"]["rho_A"])
    left, right = boundary_rates(case.gas, "left"), boundary_rates(case.gas, "right")
    assert left[0] == case.left["alpha1"]
    assert right[3] == case.right["beta1"]
    if case.gas.family == "charge":
        p, q = case.w["w24"], case.w["w42"]
    else:
        p = case.h["h3"] + case.ratio * case.h["r4"]
        q = case.h["h1"] + case.ratio * case.h["r2"]
    d1 = q * case.nu2 / case.nu1 if case.z2 else case.w["w42"] / case.nu1
    d2 = p * case.nu1 / case.nu2 if case.z2 else 0.0
    assert data["d1"] == pytest.approx(d1, rel=1e-12)
    assert data["d2"] == pytest.approx(d2, rel=1e-12, abs=1e-14)
    weights = [case.weights1 / case.nu1, case.weights2 / case.nu2]
    for name in ("A", "B"):
        n = case.gas.states.index(name)
        assert data["densities"][f"rho_{name}"] == pytest.approx([w[n] for w in weights], abs=1e-14)
    currents = [case.gas.current(z) for z in (case.z1, case.z2)]
    assert data["currents"] == pytest.approx(currents, abs=1e-14)
    # profile and mean position from the mixture of shock measures, not from the generator
    walk = shocks.ShockWalk(5, d1, d2, *data["end_rates"])
    mixture = walk.stationary_mixture()
    for name in ("A", "B"):
        n = case.gas.states.index(name)
        expected = [
            sum(m * (weights[0] if site <= k else weights[1])[n] for k, m in enumerate(mixture))
            for site in range(1, 6)
        ]
        assert data["stationary_profile"][f"rho_{name}"] == pytest.approx(expected, abs=1e-11)
    evolved = generator.evolve(
        case.gas, 5, shocks.shock_vector(case.gas, 5, 2, case.z1, case.z2), [0.5, 2.0]
    )
    expected = [shocks.equimolar_position(case.gas, 5, s, case.z1, case.z2) for s in evolved]
    assert data["mean_shock_position"] == pytest.approx(expected, abs=1e-10)


def test_h_r_c_and_24_rates_give_the_same_report(tmp_path: Path) -> None:
    case = shock_internal()
    long = checked(write(tmp_path / "w.toml", contents(case)))
    short = checked(
        write(tmp_path / "h.toml", {**contents(case), "rates": {**case.h, "c": case.ratio}})
    )
    for key in ("d1", "d2", "shock_velocity", "shock_diffusion"):
        assert long[key] == pytest.approx(short[key], rel=1e-12)


def test_fugacities_left_out_are_read_from_the_ends(tmp_path: Path) -> None:
    case = shock_charge("two-sided")
    data = contents(case)
    del data["z1"], data["z2"]
    found = checked(write(tmp_path / "m.toml", data))
    assert found["d1"] == pytest.approx(case.w["w42"] * case.nu2 / case.nu1, rel=1e-8)


def test_off_the_manifold_says_which_condition_fails_and_by_how_much(tmp_path: Path) -> None:
    case = shock_charge("two-sided")
    data = contents(case)
    data["rates"]["w37"] += 0.125
    out = tmp_path / "out.json"
    result = run("check", write(tmp_path / "m.toml", data), "--json", out)
    assert result.exit_code == 0
    found = json.loads(out.read_text())
    failing = {
        c["equation"]: c["residual"] for c in found["conditions"] if abs(c["residual"]) > 1e-9
    }
    assert failing == {"2.36": pytest.approx(-0.125), "2.171": pytest.approx(0.125)}
    assert found["stationarity_residual"] > 1e-3
    assert found["random_walk_residual"] > 1e-3
    assert found["closes_at_ends"] is False
    assert re.search(r"\(2\.171\) w37 = w24 - \(1\+X\) w35: off by 0\.125", result.stdout)


def test_stationary_without_a_walk(tmp_path: Path) -> None:
    """Rates of (2.36) only, ends that hold both fugacities: stationary, no random walk."""
    bulk = {
        "w24": 1.0,
        "w42": 0.4,
        "w37": 0.7,
        "w73": 0.3,
        "w68": 0.5,
        "w86": 0.9,
        "w53": 0.6,
        "w57": 0.8,
        "w35": 0.2,
        "w75": 0.5,
    }
    bulk["w73"] = (
        bulk["w37"]
        - bulk["w24"]
        + bulk["w42"]
        - bulk["w68"]
        + bulk["w86"]
        + (0.2 * 0.8 - 0.6 * 0.5) / 0.7
    )
    model = charge_gas(bulk).with_reservoirs(0.6, 1.4)
    ends = {}
    for side, names, rates in (
        ("left", ("alpha", "gamma"), boundary_rates(model, "left")),
        ("right", ("delta", "beta"), boundary_rates(model, "right")),
    ):
        labels = [f"{name}{i}" for name in names for i in (1, 2, 3)]
        ends[side] = dict(zip(labels, rates, strict=True))
    data = checked(
        write(
            tmp_path / "m.toml", {"family": "charge", "z1": 0.6, "z2": 1.4, "rates": bulk, **ends}
        )
    )
    assert data["stationarity_residual"] < 1e-13
    assert data["random_walk_residual"] > 1e-2


def test_position_off_the_manifold_is_the_equimolar_one(tmp_path: Path) -> None:
    case = shock_charge("two-sided")
    data = contents(case)
    data["rates"]["w37"] += 0.125
    found = checked(write(tmp_path / "m.toml", data), "--from", 2, "--times", "1,0")
    assert found["mean_shock_position"][1] == pytest.approx(2, abs=1e-12)
    assert 0 < found["mean_shock_position"][0] < 5
    assert found["mean_shock_position"][0] != pytest.approx(2, abs=1e-3)


def test_ring_and_equal_fugacities(tmp_path: Path) -> None:
    case = shock_charge("two-sided")
    ring = {key: value for key, value in contents(case).items() if key not in ("left", "right")}
    data = checked(write(tmp_path / "ring.toml", ring))
    assert data["stationarity_residual"] < 1e-13
    assert data["d1"] is None
    assert data["stationary_profile"] is None  # one stationary state per charge
    same = contents(case)
    model = case.gas.with_reservoirs(0.6, 0.6)
    same["right"] = dict(
        zip(
            ("delta1", "delta2", "delta3", "beta1", "beta2", "beta3"),
            boundary_rates(model, "right"),
            strict=True,
        )
    )
    same["z2"] = same["z1"]
    data = checked(write(tmp_path / "same.toml", same))
    assert data["stationarity_residual"] < 1e-13
    assert data["d1"] is None
    assert data["stationary_profile"]["rho_A"] == pytest.approx([data["densities"]["rho_A"][0]] * 5)


def spoiled(tmp_path: Path, change: Change, suffix: str = ".toml") -> Path:
    data = contents(shock_charge("two-sided"))
    change(data)
    return write(tmp_path / f"bad{suffix}", data)


BAD = {
    "negative": (lambda d: d["rates"].update(w24=-1.0), r"rate w24 = -1\.0: must not be negative"),
    "nan": (lambda d: d["rates"].update(w24=float("nan")), "rate w24 = nan: must be finite"),
    "infinite": (
        lambda d: d["left"].update(alpha1=float("inf")),
        "rate alpha1 = inf: must be finite",
    ),
    "off the law": (
        lambda d: d["rates"].update(w12=1.0),
        r"rate w12 \(A0 -> AA\) breaks the conservation law",
    ),
    "unknown rate": (lambda d: d["rates"].update(w0=1.0), "unknown rate 'w0'"),
    "unknown end rate": (lambda d: d["left"].update(beta1=1.0), "unknown rate 'beta1'"),
    "unknown field": (
        lambda d: d.update(temperature=1.0),
        "temperature: extra inputs are not permitted",
    ),
    "family": (
        lambda d: d.update(family="mass"),
        "family: input should be 'charge' or 'internal-state'",
    ),
    "one end": (
        lambda d: d.pop("right"),
        "inconsistent boundaries: rates given at the left end only",
    ),
    "text": (lambda d: d["rates"].update(w24="fast"), "rates.w24: input should be a valid number"),
    "fugacity": (lambda d: d.update(z1=-0.5), "z1: input should be greater than or equal to 0"),
    "no rates": (lambda d: d.pop("rates"), "rates: field required"),
    "ends": (
        lambda d: d["left"].update(alpha3=3.0),
        r"inconsistent boundaries: \(2\.39\) left end keeps the density of B at z = 0.6 fails by",
    ),
    "ends without z": (
        lambda d: (d.pop("z1"), d["left"].update(alpha3=3.0)),
        "inconsistent boundaries: no fugacity solves",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_get_one_message_and_exit_code_2(name: str, tmp_path: Path) -> None:
    change, message = BAD[name]
    result = run("check", spoiled(tmp_path, change), "--sites", 4)
    assert result.exit_code == 2
    assert re.search(message, result.stderr), result.stderr
    assert result.stderr.count("\n") == 1
    assert "Traceback" not in result.output
    assert isinstance(result.exception, SystemExit)


def test_json_with_nan_and_broken_syntax(tmp_path: Path) -> None:
    bad = spoiled(tmp_path, lambda d: d["rates"].update(w24=float("nan")), ".json")
    assert "must be finite" in run("check", bad).stderr
    broken = tmp_path / "broken.toml"
    broken.write_text("family = ")
    result = run("check", broken)
    assert result.exit_code == 2
    assert "not readable as toml" in result.stderr
    result = run("check", tmp_path / "absent.toml")
    assert result.exit_code == 2
    assert "No such file" in result.stderr


def test_inconsistent_ends_still_leave_the_residuals_in_OUT(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    path = spoiled(tmp_path, lambda d: d["left"].update(alpha3=3.0))
    assert run("check", path, "--json", out).exit_code == 2
    assert json.loads(out.read_text())["stationarity_residual"] > 1e-3


@pytest.mark.parametrize("sites", [25, 60])
def test_too_many_sites_names_the_bytes(sites: int) -> None:
    result = run("check", EXAMPLES[0], "--sites", sites)
    assert result.exit_code == 2
    assert re.search(rf"L = {sites} .*needs [\d.]+e\+\d+ bytes of memory", result.stderr)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--from", "2"), "given together"),
        (("--from", "9", "--times", "1"), r"must lie in 0\.\.4"),
        (("--from", "2", "--times", "1,x"), "numbers separated by commas"),
        (("--from", "2", "--times", "-1"), "must be between 0 and"),
        (("--json", "/no/such/folder/out.json"), "No such file or directory"),
    ],
)
def test_bad_options(options: tuple[str, ...], message: str) -> None:
    result = run("check", EXAMPLES[1], "--sites", 4, *options)
    assert result.exit_code == 2
    assert re.search(message, result.stderr)


def test_simulate_writes_results_and_figures(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    path = next(p for p in EXAMPLES if p.stem == "one_sided")
    arguments = (
        "simulate",
        path,
        "--sites",
        400,
        "--replicas",
        20,
        "--time",
        100,
        "--samples",
        11,
        "--seed",
        3,
        "--json",
        out,
    )
    result = run(*arguments, "--figures", tmp_path)
    assert result.exit_code == 0, result.output
    data = json.loads(out.read_text())
    assert (
        abs(data["shock_velocity"] - data["predicted_velocity"]) < 4 * data["shock_velocity_error"]
    )
    assert len(data["mean_shock_position"]) == 11
    assert np.shape(data["final_profile"]["rho_A"]) == (400,)
    for name in ("space_time", "profile", "position"):
        assert (tmp_path / f"{name}.png").stat().st_size > 5000
    run(*arguments)
    assert json.loads(out.read_text()) == data  # the seed decides


def test_simulate_warns_where_the_shock_meets_an_end() -> None:
    path = next(p for p in EXAMPLES if p.stem == "one_sided")
    result = run("simulate", path, "--sites", 40, "--replicas", 2, "--time", 100)
    assert result.exit_code == 0
    assert "may reach an end" in result.stderr


def test_hydro_writes_results_and_figures(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    path = next(p for p in EXAMPLES if p.stem == "internal_state")
    result = run(
        "hydro",
        path,
        "--times",
        "0.1",
        "--cells",
        50,
        "--sites",
        200,
        "--replicas",
        4,
        "--json",
        out,
        "--figures",
        tmp_path,
    )
    assert result.exit_code == 0, result.output
    data = json.loads(out.read_text())
    assert data["wave"] == "shock"
    assert data["domain_wall_rates"] == pytest.approx(data["hopping_rates"], abs=1e-12)
    assert np.shape(data["monte_carlo"]) == (1, 50)
    for name in ("current", "step", "phase_diagram"):
        assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_read_returns_what_the_file_says() -> None:
    model, z1, z2 = spec.read(next(p for p in EXAMPLES if p.stem == "asep"))
    assert (z1, z2) == (0.25, 1.25)
    assert model.w(2, 4) == 1.0  # A0 -> 0A
    assert boundary_rates(model, "left") == (0.21, 0.0, 0.0, 0.2, 0.0, 0.0)
