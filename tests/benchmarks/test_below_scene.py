"""Fields that no scene has: each changes what it says, inside and not after."""

from pathlib import Path
from typing import Any

import pytest

import below_scene
from analysis import RunDirectory
from lammps_inputs import SceneError, make_scene
from lammps_inputs.deck import script
from lammps_inputs.scenes.claylike import Claylike
from srd_driver.sweep import Run

REFLECTION: dict[str, Any] = {
    "coupling": "reflection",
    "cells": 12,
    "potential": "hertz",
    "lubrication": "off",
    "volume_fraction": 0.3,
    "md_steps_per_collision": 30,
    "sampling_interval": 1.2,
    "duration": 2.4,
    "equilibration": 0,
}


def test_placement_is_a_word_of_the_deck() -> None:
    scene = make_scene("claylike", **REFLECTION)
    usual = script(scene, "mpc")
    with below_scene.changed({"placement": "nearest"}):
        assert script(scene, "mpc") == usual.replace("reflect 1 2.0 entry", "reflect 1 2.0 nearest")
    assert script(scene, "mpc") == usual
    assert "reflect 1 2.0 entry" in usual


def test_gaps_of_lubrication_are_in_the_potential_and_refused_with_it() -> None:
    scene = below_scene.make(
        "claylike", {"closest": 0.1, "farthest": 0.4, "coupling": "reflection"}
    )
    assert isinstance(scene, Claylike)
    assert scene.between is not None
    assert (scene.between.closest, scene.between.farthest) == pytest.approx((0.2, 0.8))
    assert "0.2 0.8" in script(scene, "mpc"), "also when nothing is changed any more"
    with pytest.raises(SceneError, match="friction in contact takes"):
        below_scene.make("claylike", {"closest": 0.001})


def test_runs_with_such_fields_are_other_runs(tmp_path: Path) -> None:
    """Fluid that may meet one sphere only ends elsewhere; what is finished is not run again."""
    found = {}
    for most in (1, 10):
        fields = REFLECTION | {"N_max": most}
        scene = below_scene.make("claylike", fields)
        run = Run(tmp_path / str(most), scene, "reference")
        assert below_scene.execute({run: fields}, 1) == []
        found[most] = RunDirectory(run.folder).particles().velocities
        written = (run.folder / "trajectory.lammpsdump").stat().st_mtime_ns
        assert below_scene.execute({run: fields}, 1) == []
        assert (run.folder / "trajectory.lammpsdump").stat().st_mtime_ns == written
    assert abs(found[1][-1] - found[10][-1]).max() > 1e-6


def test_a_run_that_stops_is_a_failure(tmp_path: Path) -> None:
    fields = REFLECTION | {"placement": "elsewhere"}
    run = Run(tmp_path / "run", below_scene.make("claylike", fields), "mpc")
    (failure,) = below_scene.execute({run: fields}, 1)
    assert "elsewhere" in failure.message
