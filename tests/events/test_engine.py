"""The event-driven engine: cases by hand, brute force, and what must hold to the last bit."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from srd_driver.events import EventError, HardSpheres, PairReactions, WallReactions
from srd_driver.events.brute_force import BruteForce


def slit(seed: int = 1, count: int = 200, reactions: WallReactions | None = None) -> HardSpheres:
    return HardSpheres.fluid(count, [7.0, 6.5, 5.0], walls=(2,), reactions=reactions, seed=seed)


def test_head_on_collision_of_two() -> None:
    engine = HardSpheres([[1, 5, 5], [4, 5, 5]], [[1, 0, 0], [-1, 0, 0]], [10, 10, 10])
    engine.advance(0.99)
    assert engine.collisions == 0
    engine.advance(1.01)  # contact after 1, at x = 2 and 3
    assert engine.collisions == 1
    assert engine.velocities.tolist() == [[-1, 0, 0], [1, 0, 0]]
    assert engine.positions == pytest.approx(np.array([[1, 5, 5], [4, 5, 5]]))
    assert engine.virial == pytest.approx(2.0)  # sigma |u|


def test_oblique_collision_of_two_disks() -> None:
    """Centres at 60 degrees at contact: the component along them changes hands."""
    y = np.sqrt(3) / 2
    engine = HardSpheres([[1, 5], [5, 5 + y]], [[2, 0], [0, 0]], [10, 10])
    engine.advance(1.75 + 0.5)  # contact when x = 4.5
    normal = np.array([0.5, y])
    assert engine.velocities[1] == pytest.approx(2 * 0.5 * normal)
    assert engine.velocities[0] == pytest.approx(np.array([2, 0]) - 2 * 0.5 * normal)


def test_collision_through_a_periodic_face_and_its_images() -> None:
    engine = HardSpheres([[1, 5, 5], [9, 5, 5]], [[-1, 0, 0], [1, 0, 0]], [10, 10, 10])
    engine.advance(1.5)  # 2 apart through the face: contact after 0.5
    assert engine.collisions == 1
    assert engine.positions[:, 0] == pytest.approx([1.5, 8.5])


def test_images_unwrap_the_path() -> None:
    engine = HardSpheres([[1, 5, 5]], [[2.5, -1, 0]], [10, 10, 10])
    engine.advance(10)
    assert engine.images.tolist() == [[2, -1, 0]]
    assert engine.positions + 10 * engine.images == pytest.approx(np.array([[26, -5, 5]]))


def test_three_in_a_row_pass_the_velocity_on() -> None:
    start = [[2.0, 5, 5], [4.0, 5, 5], [7.0, 5, 5]]
    engine = HardSpheres(start, [[1, 0, 0], [0, 0, 0], [0, 0, 0]], [20, 10, 10])
    engine.advance(1 + 2 + 0.5)  # gaps of 1 and 2
    assert engine.collisions == 2
    assert engine.velocities[:, 0].tolist() == [0, 0, 1]
    assert engine.positions[:, 0] == pytest.approx([3.0, 6.0, 7.5])


def test_a_sphere_between_walls_is_there_and_back() -> None:
    engine = HardSpheres([[5, 5, 1.5]], [[0, 0, 2.0]], [10, 10, 4], walls=(2,))
    engine.advance(1 + 1.5 + 0.25)  # up 2, down 3, up 0.5
    assert engine.wall_hits == 2
    assert engine.positions[0] == pytest.approx([5, 5, 1.0])
    assert engine.wall_momentum[2].tolist() == [4, 4]


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("walls", [(), (0,), (1,), (0, 1)])
def test_trajectory_of_brute_force(dimensions: int, walls: tuple[int, ...]) -> None:
    lengths = [6.0, 5.0, 5.5][:dimensions]
    count = 14 if dimensions == 2 else 50
    engine = HardSpheres.fluid(count, lengths, walls, seed=3)
    brute = BruteForce(engine.positions, engine.velocities, lengths, walls)
    time = 0.6 if dimensions == 3 else 2.0
    engine.advance(time)
    brute.advance(time)
    assert engine.collisions == sum(contact.j is not None for contact in brute.contacts)
    assert engine.wall_hits == sum(contact.j is None for contact in brute.contacts)
    assert engine.collisions > 30
    unwrapped = engine.positions + engine.images * np.array(lengths)
    assert unwrapped == pytest.approx(brute.positions, abs=1e-6)
    assert engine.velocities == pytest.approx(brute.velocities, abs=1e-6)


def test_chances_of_the_brute_force_wall_hits() -> None:
    """q by the rule, from an independent list of who hit which wall when."""
    p = [0.1, 1.0]
    engine = slit(count=60, reactions=WallReactions(p))
    brute = BruteForce(engine.positions, engine.velocities, engine.lengths, (2,))
    engine.advance(0.8)
    brute.advance(0.8)
    q = np.full((60, 2), 0.5)
    expected = np.zeros((2, 2))
    for contact in brute.contacts:
        if contact.j is None:
            reacting = p * (1 - q[contact.i] if contact.side else q[contact.i])
            q[contact.i] += reacting if contact.side else -reacting
            expected[contact.side] += reacting
    assert engine.wall_hits > 10
    assert engine.chances[0] == pytest.approx(q)
    assert engine.take_profile().reactions[:, 1] == pytest.approx(expected)


def test_cutting_and_looking_change_no_bit(tmp_path: Path) -> None:
    whole, cut = slit(reactions=WallReactions([0.3])), slit(reactions=WallReactions([0.3]))
    whole.advance_to(5.0)
    for time in (0.013, 1.0, 1.7, 4.2):
        cut.advance_to(time)
        cut.sample()
        cut.save(tmp_path / "state.npz")
        cut = HardSpheres.load(tmp_path / "state.npz")
    cut.advance_to(5.0)
    assert np.array_equal(whole.positions, cut.positions)
    assert np.array_equal(whole.velocities, cut.velocities)
    assert np.array_equal(whole.labels, cut.labels)
    assert np.array_equal(whole.chances, cut.chances)
    assert whole.collisions == cut.collisions > 1000


def test_loading_gives_the_bits_of_not_stopping(tmp_path: Path) -> None:
    reactions = PairReactions([0.2, 0.7], centers=[0, 5], cutoff=2.6)
    engine = HardSpheres.fluid(120, [6, 6, 6], reactions=reactions, seed=2)
    engine.advance(1.0)
    engine.sample()
    engine.save(tmp_path / "state.npz")
    again = HardSpheres.load(tmp_path / "state.npz")
    for either in (engine, again):
        either.advance(3.0)
        either.sample()
        either.save(tmp_path / f"{either is again}.npz")
    with np.load(tmp_path / "False.npz") as a, np.load(tmp_path / "True.npz") as b:
        for name in a.files:
            if name not in ("s_near", "s_rows", "s_times"):  # scratch room
                assert np.array_equal(a[name], b[name]), name


def test_looking_ahead_changes_no_bit() -> None:
    """The memory of coming events is fetched early in large systems; here in a small one."""
    plain, ahead = slit(count=150), slit(count=150)
    assert plain._spheres.large == 0
    ahead._spheres = ahead._spheres._replace(large=1)
    for engine in (plain, ahead):
        engine.advance(3.0)
    assert plain.collisions > 1000
    assert np.array_equal(plain.positions, ahead.positions)
    assert np.array_equal(plain.velocities, ahead.velocities)


def test_rows_lie_in_cache_lines(tmp_path: Path) -> None:
    engine = slit(count=50)
    engine.save(tmp_path / "state.npz")
    for each in (engine, HardSpheres.load(tmp_path / "state.npz")):
        for array in (each._spheres.body, each._spheres.link, each._spheres.content):
            assert array.ctypes.data % 64 == 0


def test_crowded_cells_spill(tmp_path: Path) -> None:
    """Eight small spheres in one cell of a dilute system, more than its row lists."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    start = 0.3 + 1.001 * corners
    velocities = np.random.default_rng(2).normal(size=(8, 3))
    engine = HardSpheres(start, velocities, [9.0, 9.0, 9.0])
    assert engine._spheres.content[:, 0].max() > 3
    brute = BruteForce(start, velocities, [9.0, 9.0, 9.0])
    engine.advance(2.0)
    brute.advance(2.0)
    assert engine.collisions == len(brute.contacts) > 3
    assert engine.positions + engine.images * 9.0 == pytest.approx(brute.positions, abs=1e-9)


def test_seeds() -> None:
    assert np.array_equal(slit(1).positions, slit(1).positions)
    assert not np.array_equal(slit(1).velocities, slit(2).velocities)


def test_energy_momentum_and_no_overlap() -> None:
    engine = slit(count=180)  # packing 0.41
    momentum = engine.velocities.sum(axis=0)[:2]
    energy = engine.energy()
    assert momentum == pytest.approx([0, 0], abs=1e-12)
    assert energy == pytest.approx((3 * 180 - 2) / 2)
    for _ in range(20):
        engine.advance(1.0)
        assert engine.nearest() > 1 - 1e-9
        z = engine.positions[:, 2]
        assert z.min() > 0.5 - 1e-9
        assert z.max() < 4.5 + 1e-9
    assert engine.energy() == pytest.approx(energy, rel=1e-12)
    assert engine.velocities.sum(axis=0)[:2] == pytest.approx(momentum, abs=1e-11)


def test_chance_is_the_mean_label_over_lots() -> None:
    """The same trajectory with 400 seeds of the lots; walls and pairs."""
    for reactions, box, walls in (
        (WallReactions([0.1, 0.5]), [6, 6, 5], (2,)),
        (PairReactions([0.1, 0.5], centers=[3, 8], cutoff=2.7), [6, 6, 6], ()),
    ):
        start = HardSpheres.fluid(90, box, walls, seed=1)
        total, chances = np.zeros((1, 1, 1)), []
        for seed in range(400):
            engine = HardSpheres(
                start.positions, start.velocities, box, walls, reactions=reactions, seed=seed
            )
            engine.advance(4.0)
            total = total + engine.labels.astype(float)
            chances.append(engine.chances.copy())
        assert all(np.array_equal(chances[0], other) for other in chances)
        q = chances[0]
        drawn = (q > 0.02) & (q < 0.98)
        assert drawn.sum() > 50
        assert np.array_equal((total / 400)[(q == 0) | (q == 1)], q[(q == 0) | (q == 1)])
        deviation = (total / 400 - q)[drawn] / np.sqrt(q * (1 - q) / 400)[drawn]
        assert abs(deviation).max() < 5
        assert np.sqrt(np.mean(deviation**2)) == pytest.approx(1, abs=0.2)


def test_pairs_enter_the_cutoff_when_a_fine_clock_says_so() -> None:
    """Visits to R_cut, against positions looked at many times in a mean free flight."""
    reactions = PairReactions([0.5], centers=[0, 7], cutoff=2.5)
    engine = HardSpheres.fluid(80, [6.0, 6.0, 6.0], seed=4, reactions=reactions)
    engine.advance(3.0)
    engine.take_profile()
    entered = 0
    inside = None
    while engine.time < 13.0:
        engine.advance(1e-3)
        r = engine.positions[:, None] - engine.positions[[0, 7]]
        distance = np.sqrt(((r - 6 * np.round(r / 6)) ** 2).sum(axis=2))
        now = distance < 2.5
        if inside is not None:
            entered += int((now & ~inside).sum())
        inside = now
    hits = engine.take_profile().hits
    assert entered > 100
    assert hits[1] == pytest.approx(entered, abs=0.02 * entered)  # a clock misses the shortest
    assert hits[1] >= entered


BAD: list[tuple[dict[str, Any], str]] = [
    ({"lengths": [10.0]}, "lengths: 1 of them; a box has 2 or 3"),
    ({"lengths": [10.0, 10.0, 2.9]}, r"lengths\[2\]: 2.9; a periodic axis must have at least"),
    ({"walls": (2,), "lengths": [10, 10, 1.0]}, "between walls it must exceed the diameter, 1"),
    ({"walls": (3,)}, "the axes are 0 to 2"),
    ({"positions": [[5, 5, 5], [5, 5, 5.9]]}, "particles 0 and 1 overlap: they are 0.9 apart"),
    ({"walls": (2,), "positions": [[5, 5, 0.4]]}, "particle 0 is in a wall"),
    ({"positions": [[5, 5, np.nan]]}, "not all are finite"),
    ({"velocities": [[1, 2]]}, r"both must be \(N, 3\)"),
    ({"diameter": -1.0}, "diameter: -1; it must be positive"),
    ({"reactions": WallReactions([0.1])}, "reactions.axis: 2; it has no walls"),
    ({"reactions": WallReactions([1.5]), "walls": (2,)}, r"each must be in \(0, 1\]"),
    ({"reactions": WallReactions([0.0]), "walls": (2,)}, r"each must be in \(0, 1\]"),
    ({"reactions": PairReactions([0.1], [0], 5.1)}, "below half the shortest box length, 5"),
    ({"reactions": PairReactions([0.1], [9], 3)}, "must be in 0 to 0"),
    ({"reactions": PairReactions([0.1], [0, 0], 3)}, "each only once"),
    ({"reactions": PairReactions([0.1], [0], 3), "walls": (1,)}, "need a box without walls"),
]


@pytest.mark.parametrize(("changes", "message"), BAD)
def test_bad_systems_are_refused(changes: dict[str, Any], message: str) -> None:
    system: dict[str, Any] = {
        "positions": [[5.0, 5.0, 5.0]],
        "lengths": [10.0, 10.0, 10.0],
    } | changes
    system.setdefault("velocities", np.ones_like(system["positions"], dtype=float))
    with pytest.raises(EventError, match=message):
        HardSpheres(**system)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(EventError, match=r"400 spheres .* \(packing fraction 0.931\) do not fit"):
        HardSpheres.fluid(400, [6.0, 7.5, 5.0], walls=(2,))
    with pytest.raises(EventError, match="count: 0; at least 1"):
        HardSpheres.fluid(0, [6.0, 6.0, 6.0])
    with pytest.raises(EventError, match="temperature: -1; it must be positive"):
        HardSpheres.fluid(1, [6.0, 6.0, 6.0], temperature=-1)


@pytest.mark.parametrize("packing", [0.05, 0.35, 0.45])
@pytest.mark.parametrize("walls", [(), (2,), (0, 2)])
def test_initial_states_fit(packing: float, walls: tuple[int, ...]) -> None:
    lengths = np.array([12.3, 11.1, 9.7])
    count = int(packing * lengths.prod() / (np.pi / 6))
    engine = HardSpheres.fluid(count, lengths, walls, seed=5)
    assert engine.packing_fraction() == pytest.approx(packing, abs=1e-3)
    assert engine.nearest() >= 1


def test_a_checkpoint_of_another_version_is_told(tmp_path: Path) -> None:
    file = tmp_path / "state.npz"
    np.savez(file, dimensions=3, s_x=np.zeros(3))
    with pytest.raises(EventError, match=r"state.npz: of another version of narrows: it has no "):
        HardSpheres.load(file)
