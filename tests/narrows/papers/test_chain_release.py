"""Erratum of 4.5: the released chain spreads at the tail, not at the head."""

from pathlib import Path

import numpy as np
import pytest

from analysis import RunDirectory, chain
from lammps_inputs.scenes.channel import Channel
from srd_driver import Simulation


@pytest.mark.statistics
def test_the_tail_spreads_and_the_head_closes_up(tmp_path: Path) -> None:
    growth = []
    for seed in range(1, 5):
        scene = Channel.make(
            length=300,
            colloids=31,
            spacing=5.0,
            equilibration=0,
            duration=300,
            sampling_interval=3.0,
            seed=seed,
        )
        with Simulation(scene, "mpc", tmp_path / str(seed)) as simulation:
            simulation.finish()
        colloids = chain.chain_of(RunDirectory(tmp_path / str(seed)))
        spacings = chain.neighbour_spacings(colloids.x)
        groups = chain.group_spacings(spacings)
        growth.append(groups[-1] - groups[0])
    each = np.array(growth)
    print("growth of D_1 .. D_6 to t = 300:", each.mean(axis=0), "+-", each.std(axis=0, ddof=1) / 2)
    gap = each[:, -1] - each[:, 0]  # tail less head; the thesis' words say negative
    assert gap.mean() > 5 * gap.std(ddof=1) / np.sqrt(len(gap))
    assert each[:, 0].mean() < 0
