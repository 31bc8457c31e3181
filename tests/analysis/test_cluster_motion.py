"""The parts of squared displacements: cases by hand, and a sum that holds for any motion."""

import numpy as np
import pytest

from analysis.cluster_motion import cluster_motion

BOX = (9.0, 9.0, 9.0)
START = np.array([[1.0, 1, 1], [2, 1, 1], [3, 1, 1], [6, 6, 6], [8.8, 4, 4], [9.2, 4, 4]])


def test_by_hand() -> None:
    """A trimer drifts and stretches, a pair across the boundary parts, and another is alone."""
    end = START.copy()
    end[:3] += [0.0, 0.5, 0.0]
    end[0, 0] -= 0.1
    end[2, 0] += 0.1
    end[3] += [0.0, 0.0, 2.0]
    end[5] += [1.5, 0.0, 0.0]
    found = cluster_motion(np.array([START, end]), BOX, 1.2, 1)
    assert found.alone[0] == pytest.approx(4.0 / 6)
    assert found.left[0] == pytest.approx(1.5**2 / 6)
    assert found.together[0] == pytest.approx(3 * 0.25 / 6)
    assert found.about[0] == pytest.approx(0.02 / 6)
    assert found.broken[0] == pytest.approx(1 / 3)


def test_whoever_stays_has_a_neighbour_of_before() -> None:
    """The last of a trimer leaves; the other two go on together."""
    end = START.copy()
    end[2, 0] += 1.0
    found = cluster_motion(np.array([START, end]), BOX, 1.2, 1)
    assert found.left[0] == pytest.approx(1.0 / 6)
    assert found.about[0] == 0
    assert found.together[0] == 0


def test_parts_add_up_over_windows() -> None:
    random = np.random.default_rng(3)
    paths = random.uniform(0, 9, size=(60, 3)) + random.normal(size=(11, 60, 3)).cumsum(axis=0) / 5
    found = cluster_motion(paths, BOX, 1.8, 5)
    moved = paths[[5, 10]] - paths[[0, 5]]
    np.testing.assert_allclose(found.all, (moved**2).sum(axis=2).mean(axis=1))
    assert min(found.left.min(), found.about.min(), found.together.min()) > 0


def test_without_bonds_all_are_alone() -> None:
    paths = np.array([START, START + 1.0])
    found = cluster_motion(paths, BOX, 0.1, 1)
    assert found.alone[0] == pytest.approx(3.0)
    assert found.broken[0] == 0
    with pytest.raises(ValueError, match="2 frames: must be more than the lag, 2"):
        cluster_motion(paths, BOX, 0.1, 2)
