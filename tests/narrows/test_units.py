"""`narrows units`: the laboratory beside the simulation, and a scene file of it."""

import re
from pathlib import Path

import pytest

from lammps_inputs import all_scenes, make_scene, read_scene
from tests.conftest import Run


def printed_table(text: str) -> dict[str, tuple[float, float, str]]:
    """Laboratory, simulation and change, by symbol."""
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {row[1].strip(): (float(row[3]), float(row[4]), row[5]) for row in rows[2:]}


TABLE_2 = {"tau_S": 0.791, "tau_D": 0.582, "tau_G": 36.5e-3, "tau_V": 7.45e-6, "tau_F": 0.32e-6}
TABLES = {
    # Table III; its tau_F of 22.9 ms is 23.9 ms by its own (24)
    "reflection": (
        ["coupling=reflection"],
        {"tau_V": 2.03e-3, "tau_F": 23.9e-3, "tau_P": 10.36e-3},
    ),
    # Table IV, of cells that the paper rounds to 0.625 um; it goes on with a rounded 2.05 ms
    "cell": (["cell_edge=0.625 um"], {"tau_V": 1.56e-3, "tau_F": 14.0e-3, "tau_P": 6.02e-3}),
}


@pytest.mark.parametrize("coupling", TABLES)
def test_tables_of_hecht_2005(coupling: str, command: Run) -> None:
    settings, simulated = TABLES[coupling]
    words = [word for each in ["radius=0.4 um", *settings] for word in ("--set", each)]
    table = printed_table(command("narrows", "units", "claylike", *words).stdout)
    for symbol, value in TABLE_2.items():
        assert table[symbol][0] == pytest.approx(value, rel=3e-3)  # a last digit
    for symbol, value in simulated.items():
        assert table[symbol][1] == pytest.approx(value, rel=7e-3)
    assert table["Pe"][:2] == pytest.approx((0.737, 0.737), rel=1e-3)
    assert {symbol for symbol, row in table.items() if row[2] == "kept"} == {
        *("R", "A_H / kBT", "v_S", "D", "tau_S", "tau_D", "tau_G", "Pe"),
    }


def test_a_scene_file_of_the_laboratory(tmp_path: Path, command: Run) -> None:
    """Gravity of the file keeps the Peclet number of 9.81 m/s^2, or the one that was asked for."""
    file = tmp_path / "mine.toml"
    command("narrows", "units", "claylike", "--set", "radius=0.4 um", "--out", file)
    scene = make_scene("claylike", **{k: v for k, v in read_scene(file).items() if k != "scene"})
    assert scene.model_dump()["peclet"] == pytest.approx(0.737, abs=1e-3)
    _, asked = all_scenes()["claylike"].of_laboratory(peclet=2)
    assert next(row for row in asked.rows if row.symbol == "Pe").real == pytest.approx(2)


def test_a_channel_of_the_laboratory(tmp_path: Path, command: Run) -> None:
    file = tmp_path / "channel.toml"
    words = ["particle_radius=0.5 um", "channel_width=3 um", "acceleration=100 m/s^2"]
    settings = [word for each in words for word in ("--set", each)]
    told = command("narrows", "units", "channel", *settings, "--out", file).stdout
    table = printed_table(told)
    assert table["Pe"][2] == table["tau_D"][2] == table["tau_S"][2] == "kept"
    assert table["Re"][1] < 1
    fields = read_scene(file)
    assert fields["width"] == pytest.approx(12)  # 3 um, the radius 2 a0
    assert fields["length"] == 80


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["bulk"], "scene bulk: stands for nothing in the laboratory"),
        (["pipe"], "scene = 'pipe': must be one of"),
        (["channel", "--set", "channel_width=3 s"], "channel_width = '3 s': .*is a quantity of"),
        (["channel", "--set", "width=3"], "width = 3: follows from the laboratory"),
        (["channel", "--set", "particle_density=900"], "particle_density = 900.0: must be more"),
        (["claylike", "--set", "radius=1 K"], "radius = '1 K': .*is a quantity of"),
    ],
)
def test_what_cannot_be_is_refused(words: list[str], message: str, command: Run) -> None:
    refused = command("narrows", "units", *words, succeed=False)
    assert refused.returncode == 2
    assert re.search(message, refused.stderr)
