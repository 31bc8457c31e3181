"""Tests of the compiled styles; skipped where they were not built, unless they must have been."""

import os

import pytest

import lammps_plugin


@pytest.fixture(autouse=True, scope="session")
def plugin() -> str:
    """The folder of the built plugin."""
    folder = lammps_plugin.folder()
    if not folder:
        reason = "the LAMMPS plugin is not built: install narrows with a C++17 compiler"
        if os.environ.get("NARROWS_REQUIRE_PLUGIN"):
            pytest.fail(reason)
        pytest.skip(reason)
    return folder
