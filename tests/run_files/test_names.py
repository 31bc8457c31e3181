"""Names of our files that become paths."""

import pytest

from run_files.names import LONGEST_NAME, checkpoint_name, is_checkpoint, is_run_name


@pytest.mark.parametrize("suffix", ["restart", "npz"])
def test_a_checkpoint_has_the_name_of_its_step(suffix: str) -> None:
    name = checkpoint_name(15000, suffix)
    assert is_checkpoint(name, 15000)
    assert not is_checkpoint(name, 1500)


@pytest.mark.parametrize(
    "name",
    [
        "checkpoint.15.txt",
        "checkpoint.015.npz",
        "checkpoint.15.npz\n",
        "../checkpoint.15.npz",
        "/checkpoint.15.npz",
        "checkpoint.-15.npz",
        "checkpoint.\u0661\u0665.npz",  # digits of another script
        "",
    ],
)
def test_other_names_are_none(name: str) -> None:
    assert not is_checkpoint(name, 15)


@pytest.mark.parametrize("name", ["gravity=0.1,seed=2", "it's here", "größe=1", "a" * LONGEST_NAME])
def test_names_of_runs(name: str) -> None:
    assert is_run_name(name)


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", ".hidden", "-rf", "a/b", "/etc", "../x", "a\n", "a\x00b", "ö" * LONGEST_NAME],
)
def test_no_run_leaves_its_sweep(name: str) -> None:
    assert not is_run_name(name)
