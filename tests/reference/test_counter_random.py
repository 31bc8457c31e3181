"""The random-number contract of docs/reference.md, against Philox written out in Python."""

import math

import numpy as np
import pytest

from srd_driver.reference.counter_random import CounterRandom, Stream, box_muller, uniform

MASK = 2**64 - 1


def philox4x64_10(key: tuple[int, int], counter: tuple[int, int, int, int]) -> list[int]:
    """Salmon et al., SC11 (2011): ten rounds on a counter of four words."""
    c, k = list(counter), list(key)
    for _ in range(10):
        high0, low0 = divmod(0xD2E7470EE14C6C93 * c[0], 2**64)
        high1, low1 = divmod(0xCA5A826395121157 * c[2], 2**64)
        c = [high1 ^ c[1] ^ k[0], low1, high0 ^ c[3] ^ k[1], low0]
        k = [(k[0] + 0x9E3779B97F4A7C15) & MASK, (k[1] + 0xBB67AE8584CAA73B) & MASK]
    return c


def test_known_answers_of_the_authors() -> None:
    # kat_vectors of Random123: counter and key all zero, and all ones
    assert philox4x64_10((0, 0), (0, 0, 0, 0)) == [
        0x16554D9ECA36314C,
        0xDB20FE9D672D0FDC,
        0xD7E772CEE186176B,
        0x7E68B68AEC7BA23B,
    ]
    assert philox4x64_10((MASK, MASK), (MASK, MASK, MASK, MASK)) == [
        0x87B092C3013FE90B,
        0x438C3C67BE8D0224,
        0x9CC7D7C69CD777B6,
        0xA09CAEBF594F0BA0,
    ]


@pytest.mark.parametrize("stream", list(Stream))
@pytest.mark.parametrize(("seed", "step", "block"), [(1, 0, 0), (2**31 - 1, 123456789, 1)])
def test_item_owns_the_block_of_counter_index_plus_one(
    stream: Stream, seed: int, step: int, block: int
) -> None:
    words = CounterRandom(seed, step).words(stream, 5, block)
    for index in range(5):
        expected = philox4x64_10((seed, stream), (index + 1, step, block, 0))
        assert words[:, index].tolist() == expected


def test_mixed_words_are_of_split_mix_from_the_words_of_item_0() -> None:
    random = CounterRandom(7, 3)
    keys = random.words(Stream.ROTATION, 1)[:, 0].tolist()
    words = random.mixed(Stream.ROTATION, 5)
    for k, key in enumerate(keys):
        for item in range(5):
            z = (key + (item + 1) * 0x9E3779B97F4A7C15) & MASK
            z = ((z ^ z >> 30) * 0xBF58476D1CE4E5B9) & MASK
            z = ((z ^ z >> 27) * 0x94D049BB133111EB) & MASK
            assert words[k, item] == z ^ z >> 31


def test_fewer_items_draw_the_same_numbers() -> None:
    random = CounterRandom(7, 3)
    np.testing.assert_array_equal(
        random.words(Stream.WALL, 10), random.words(Stream.WALL, 1000)[:, :10]
    )


def test_uniforms_take_the_upper_53_bits() -> None:
    words = np.array([0, (1 << 11) - 1, 1 << 11, 1 << 63, MASK], dtype=np.uint64)
    assert uniform(words).tolist() == [0.0, 0.0, 2.0**-53, 0.5, 1 - 2.0**-53]


def test_box_muller_pairs_the_words_in_order() -> None:
    u = np.array([[0.25], [0.125], [0.0], [0.5]])
    radius = math.sqrt(-2 * math.log(0.75))
    expected = [radius * math.sqrt(0.5), radius * math.sqrt(0.5), 0.0, 0.0]
    np.testing.assert_allclose(box_muller(u)[:, 0], expected, rtol=1e-15, atol=1e-16)


def test_normals_are_normal() -> None:
    # Kolmogorov-Smirnov at 1e-6 a row: a false alarm once in 250 000 changes of the generator
    from scipy.stats import kstest

    for row in CounterRandom(1, 0).normal(Stream.BATH, 50_000):
        assert kstest(row, "norm").pvalue > 1e-6
