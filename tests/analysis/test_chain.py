import numpy as np
import pytest

from analysis import chain


def test_perfect_crystal() -> None:
    x = np.arange(31) * 5.0 + np.array([[0.0], [100.0]])
    ordered = x[:, chain.head_order(x[0], gravity=0.1)]
    assert ordered[0, 0] == 150.0
    spacings = chain.neighbour_spacings(ordered)
    assert spacings == pytest.approx(np.full((2, 30), 5.0))
    assert chain.group_spacings(spacings) == pytest.approx(np.full((2, 6), 5.0))


def test_first_group_is_at_the_head() -> None:
    # eleven colloids; the leading one runs away by 10: only d_1 and so D_1 grow, by 10 and 10/5
    x = np.tile(np.arange(11) * 5.0, (2, 1))
    x[1, 10] += 10.0
    spacings = chain.neighbour_spacings(x[:, chain.head_order(x[0], gravity=0.1)])
    assert spacings[1].tolist() == [15.0] + [5.0] * 9
    assert chain.group_spacings(spacings)[1].tolist() == [7.0, 5.0]


def test_gravity_to_the_left_puts_the_head_left() -> None:
    x = np.array([[0.0, 5.0, 11.0]])
    order = chain.head_order(x[0], gravity=-0.1)
    assert order.tolist() == [0, 1, 2]
    assert chain.neighbour_spacings(x[:, order]).tolist() == [[5.0, 6.0]]


def test_colloids_that_change_places_have_a_negative_spacing() -> None:
    assert chain.neighbour_spacings(np.array([[5.0, 0.0], [0.0, 5.0]])).tolist() == [[5.0], [-5.0]]


@pytest.mark.parametrize(("colloids", "groups"), [(1, 0), (5, 0), (6, 1), (10, 1), (11, 2)])
def test_groups_at_the_tail_that_do_not_fill_are_left_out(colloids: int, groups: int) -> None:
    assert chain.group_spacings(np.ones((2, colloids - 1))).shape == (2, groups)


def test_group_that_is_left_out_is_the_tail() -> None:
    spacings = np.array([[1.0, 1.0, 1.0, 1.0, 1.0, 9.0]])
    assert chain.group_spacings(spacings).tolist() == [[1.0]]


def test_perfect_zigzag_has_its_amplitude() -> None:
    y = np.array([[5.7, 4.3, 5.7, 4.3, 5.7, 4.3], [5.0] * 6])
    assert chain.zigzag_amplitude(y, width=10.0) == pytest.approx([0.7, 0.0])
    assert chain.local_zigzag(y) == pytest.approx(np.array([[0.7] * 4, [0.0] * 4]))


def test_zigzags_of_opposite_phase_cancel_in_the_mean_and_show_locally() -> None:
    y = 5 + np.array([[0.7, -0.7, 0.7, -0.7, -0.7, 0.7, -0.7, 0.7]])
    assert chain.zigzag_amplitude(y, 10.0) == pytest.approx([0.0])
    local = chain.local_zigzag(y)[0]
    assert local[:2] == pytest.approx([0.7, 0.7])
    assert local[-2:] == pytest.approx([-0.7, -0.7])


def test_sloping_chain_has_no_local_zigzag() -> None:
    y = np.linspace(3.0, 7.0, 9)[None]
    assert chain.local_zigzag(y) == pytest.approx(np.zeros((1, 7)), abs=1e-14)


def test_place_of_the_zigzag_by_hand() -> None:
    # squares 9, 0, 1 at the inner colloids 1, 2, 3 from the head: (9 + 3)/10
    local = np.array([[3.0, 0.0, -1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]])
    place = chain.zigzag_place(local)
    assert place[:2] == pytest.approx([1.2, 3.0])
    assert np.isnan(place[2])
