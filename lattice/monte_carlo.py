"""Kinetic Monte Carlo: exact trajectories in continuous time, for 10^3 to 10^5 sites.

Uniformisation.  Every bond has a clock of rate R, the largest exit rate of any pair state, and each
end as many such clocks as its rates need.  With n clocks in all, attempts form a Poisson process of
rate n R: their number in a time t is Poisson(n R t), each falls on a clock chosen uniformly, and
changes its pair from j to i with probability w_ij / R, else nothing happens.  This is the master
equation (2.15) exactly, with no time step; only the times of single events are not kept.

An attempt draws two 64-bit numbers (xoshiro256++): the clock, by multiplication with rejection, and
the new pair, from a Walker alias table with 60-bit thresholds.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lattice.generator import require_memory, require_time
from lattice.models import LatticeGas, RateError, Vector

try:
    from numba import njit
except ImportError:
    raise ImportError("kinetic Monte Carlo needs numba: pip install 'narrows[lattice]'") from None

_SLOTS = 16  # columns of an alias table, a power of two not below the 9 pair states
_U = np.uint64


@dataclass(frozen=True)
class _Tables:
    """Alias tables of the bond and of the two ends, and C carried to the right by each change."""

    clock: float  # rate R of one clock
    clocks: tuple[int, int]  # number of clocks of the left and of the right end
    threshold: NDArray[np.uint64]  # (3, s^2, 16)
    target: NDArray[np.uint8]  # (3, s^2, 16, 2): outcome below the threshold, and above
    carried: NDArray[np.int64]  # (3, s^2, s^2): initial, final


def _alias(probabilities: Vector) -> tuple[NDArray[np.uint64], NDArray[np.uint8]]:
    """Walker's alias table of up to 16 outcomes."""
    share = np.zeros(_SLOTS)
    share[: probabilities.size] = probabilities * _SLOTS
    outcomes = np.column_stack([np.arange(_SLOTS), np.arange(_SLOTS)]).astype(np.uint8)
    small = [i for i in range(_SLOTS) if share[i] < 1]
    large = [i for i in range(_SLOTS) if share[i] >= 1]
    while small and large:
        low, high = small.pop(), large.pop()
        outcomes[low, 1] = high
        share[high] -= 1 - share[low]
        (small if share[high] < 1 else large).append(high)
    for rest in small + large:  # one up to rounding
        share[rest] = 1.0
        outcomes[rest, 0] = rest if rest < probabilities.size else int(probabilities.argmax())
    threshold = [min(int(x * 2.0**60), 2**60) for x in share]
    return np.array(threshold, dtype=np.uint64), outcomes


def _tables(model: LatticeGas) -> _Tables:
    s = model.size
    conserved = model.conserved.astype(np.int64)
    left = np.repeat(conserved, s)  # C of the left site of a pair
    ends = [np.zeros((s, s)) if end is None else end for end in (model.left, model.right)]
    generators = [model.bulk, *ends]
    carriers = [-left, conserved, -conserved]  # what goes right leaves the left site, enters site 1
    exits = [float(-np.diag(g).min()) for g in generators]
    clock = exits[0] or max(exits)
    clocks = [1, *(max(1, math.ceil(exit_rate / clock)) for exit_rate in exits[1:])]
    threshold = np.zeros((3, s * s, _SLOTS), dtype=np.uint64)
    target = np.zeros((3, s * s, _SLOTS, 2), dtype=np.uint8)
    carried = np.zeros((3, s * s, s * s), dtype=np.int64)
    for kind, (matrix, content) in enumerate(zip(generators, carriers, strict=True)):
        for initial in range(len(matrix)):
            chances = matrix[:, initial] / (clock * clocks[kind])
            chances[initial] += 1
            threshold[kind, initial], target[kind, initial] = _alias(np.maximum(chances, 0))
            carried[kind, initial, : len(matrix)] = content - content[initial]
    return _Tables(clock, (clocks[1], clocks[2]), threshold, target, carried)


def _next(words: Any) -> Any:
    """One 64-bit number of xoshiro256++, whose four words of state advance in place."""
    total = words[0] + words[3]
    shifted = words[1] << _U(17)
    result = ((total << _U(23)) | (total >> _U(41))) + words[0]
    words[2] ^= words[0]
    words[3] ^= words[1]
    words[1] ^= words[2]
    words[0] ^= words[3]
    words[2] ^= shifted
    words[3] = (words[3] << _U(45)) | (words[3] >> _U(19))
    return result


_next = njit(inline="always")(_next)


def _advance(
    state: Any,
    attempts: Any,
    words: Any,
    size: Any,
    periodic: Any,
    left_clocks: Any,
    clocks: Any,
    threshold: Any,
    target: Any,
    carried: Any,
    flux: Any,
) -> None:
    """`attempts` attempted updates of `state` in place; `flux` adds up C carried over each bond."""
    sites = state.size
    choices = _U(clocks)
    reject = (_U(1 << 32) - choices) % choices
    for _ in range(attempts):
        product = (_next(words) >> _U(32)) * choices
        while (product & _U(0xFFFFFFFF)) < reject:
            product = (_next(words) >> _U(32)) * choices
        # bond 0 is the left end, k the sites (k, k+1), L the right end; on a ring 0 joins L and 1
        bond = min(max(np.int64(product >> _U(32)) - left_clocks + 1, 0), sites)
        draw = _next(words)
        column = np.int64(draw >> _U(60))
        height = draw & _U((1 << 60) - 1)
        if periodic or 0 < bond < sites:
            left = bond - 1 if bond > 0 else sites - 1
            pair = np.int64(state[left]) * size + np.int64(state[bond])
            new = np.int64(target[0, pair, column, np.int64(height >= threshold[0, pair, column])])
            if new != pair:
                state[left] = new // size
                state[bond] = new % size
                flux[bond] += carried[0, pair, new]
        else:
            kind, site = (1, 0) if bond == 0 else (2, sites - 1)
            old = np.int64(state[site])
            new = np.int64(
                target[kind, old, column, np.int64(height >= threshold[kind, old, column])]
            )
            if new != old:
                state[site] = new
                flux[bond] += carried[kind, old, new]


_advance = njit(nogil=True, cache=True)(_advance)


def _posterior_mean(state: Any, evidence: Any) -> Any:
    """Mean of k under exp(sum of evidence[state] over sites 1..k), by a running maximum."""
    best = level = 0.0
    weight, moment = 1.0, 0.0
    for k in range(state.size):
        level += evidence[state[k]]
        if level > best:
            shrink = math.exp(best - level)
            weight, moment, best = weight * shrink + 1.0, moment * shrink + k + 1, level
        else:
            share = math.exp(level - best)
            weight += share
            moment += share * (k + 1)
    return moment / weight


_posterior_mean = njit(nogil=True, cache=True)(_posterior_mean)


def shock_evidence(model: LatticeGas, z1: float, z2: float) -> Vector:
    """log P1(n)/P2(n) by state, shape (s,): what a site says for lying left of the shock.

    A state that one phase never has decides, with +-1000.  Raises `RateError` for z1 = z2.
    """
    if z1 == z2:
        raise RateError(f"z1 = z2 = {z1}: there is no shock")
    with np.errstate(divide="ignore", invalid="ignore"):
        evidence = np.log(model.marginal(z1)) - np.log(model.marginal(z2))
    return np.asarray(np.clip(np.nan_to_num(evidence, nan=0.0), -1000.0, 1000.0))


@dataclass(frozen=True)
class Ensemble:
    """Averages over independent replicas, sampled at `times` (T,).

    `occupation` (T, L, s): fraction of replicas with each state; `by_replica` (R, L, s): the same
    averaged over times, per replica; `current` (R, L + 1): mean current of C from the first to the
    last time, per replica, over bond k between sites k and k + 1 (0 and L: the ends; on a ring 0
    joins L and 1 and L is unused); `positions` (R, T): fitted shock positions, if asked for;
    `history` (T, L): configurations of replica 0; `attempts`: attempted updates in all.
    """

    times: Vector
    occupation: Vector
    by_replica: Vector
    current: Vector
    positions: Vector | None
    history: NDArray[np.uint8]
    attempts: int

    def profile(self) -> tuple[Vector, Vector]:
        """Time-averaged occupation (L, s) and its standard error over replicas."""
        count = len(self.by_replica)
        return self.by_replica.mean(axis=0), self.by_replica.std(axis=0, ddof=1) / np.sqrt(count)

    def mean_current(self) -> tuple[float, float]:
        """Current of C averaged over time and bonds, and its standard error over replicas."""
        each = self.current[:, 1:-1].mean(axis=1)
        return float(each.mean()), float(each.std(ddof=1) / np.sqrt(each.size))


def simulate(
    model: LatticeGas,
    initial: Vector,
    times: Sequence[float] | Vector,
    replicas: int,
    seed: int,
    evidence: Vector | None = None,
    workers: int | None = None,
) -> Ensemble:
    """Run independent replicas from the product measure `initial`, shape (L, s), to `times`.

    Each replica starts from its own draw of `initial` at time 0 and is sampled at the increasing
    `times`.  With `evidence` (from `shock_evidence`) the shock position is fitted to every sample:
    the posterior mean of k, all k equally likely before, given the configuration and the two
    product measures.  Replica i draws from `numpy.random.SeedSequence([seed, i])`, so the result
    depends on the seed only, not on `workers`, the number of threads (default: all cores).
    Raises `ValueError` on times, replicas or shapes, `generator.TooLarge`.
    """
    moments = np.asarray(times, dtype=float)
    sites, size = initial.shape
    if moments.size == 0 or moments[0] < 0 or (np.diff(moments) <= 0).any():
        raise ValueError("times must be increasing and not negative")
    if replicas < 1 or sites < 2 or size != model.size:
        raise ValueError(
            f"replicas = {replicas}, initial of shape {initial.shape}: need replicas >= 1, "
            f"L >= 2 and {model.size} states"
        )
    samples = moments.size
    require_memory(
        (8.0 * (samples + replicas) * size + samples + 16 * replicas) * sites,
        f"{replicas} replicas of {sites} sites at {samples} times",
    )
    tables = _tables(model)
    updates = tables.clock * (sites + 1) * replicas * float(moments[-1])
    require_time(updates, 1e8 * (os.cpu_count() or 1), f"{updates:.3g} updates")
    cumulative = np.cumsum(initial, axis=1)

    def run(replica: int) -> tuple[NDArray[np.uint8], Vector, Vector, int]:
        rng = np.random.default_rng(np.random.SeedSequence([seed, replica]))
        state = (rng.random((sites, 1)) > cumulative[:, :-1]).sum(axis=1).astype(np.uint8)
        words = rng.integers(0, 2**64, 4, dtype=np.uint64)
        flux = np.zeros(sites + 1, dtype=np.int64)
        history = np.empty((samples, sites), dtype=np.uint8)
        positions = np.full(samples, np.nan)
        left, right = (1, 0) if model.periodic else tables.clocks
        clocks = sites - 1 + left + right
        now, total = 0.0, 0
        for sample, time in enumerate(moments):
            attempts = int(rng.poisson(tables.clock * clocks * (time - now)))
            _advance(
                state,
                attempts,
                words,
                size,
                model.periodic,
                left,
                clocks,
                tables.threshold,
                tables.target,
                tables.carried,
                flux,
            )
            if sample == 0:
                flux[:] = 0
            now, total = time, total + attempts
            history[sample] = state
            if evidence is not None:
                positions[sample] = _posterior_mean(state, evidence)
        span = moments[-1] - moments[0]
        return history, positions, flux / span if span > 0 else flux * np.nan, total

    occupation = np.zeros((samples, sites, size))
    by_replica = np.empty((replicas, sites, size))
    current = np.empty((replicas, sites + 1))
    positions = np.empty((replicas, samples))
    attempts = 0
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        for replica, (history, fitted, flux, total) in enumerate(pool.map(run, range(replicas))):
            present = history[:, :, None] == np.arange(size)
            occupation += present
            by_replica[replica] = present.mean(axis=0)
            current[replica], positions[replica] = flux, fitted
            attempts += total
            if replica == 0:
                first = history
    return Ensemble(
        moments,
        occupation / replicas,
        by_replica,
        current,
        None if evidence is None else positions,
        first,
        attempts,
    )


@dataclass(frozen=True)
class WalkEstimate:
    """Velocity (right-positive) and diffusion coefficient of the shock with standard errors."""

    velocity: float
    velocity_error: float
    diffusion: float
    diffusion_error: float


def estimate_walk(times: Vector, positions: Vector) -> WalkEstimate:
    """v_s and D_s of random walkers from fitted positions, shape (R, T), at uniform times.

    Given k the configuration is distributed as |k>, so the error of the fit does not depend on k:
    it shifts the mean and adds a constant to the variance.  Hence v_s is the mean displacement from
    first to last time, and D_s the difference of the displacement variances at two lags, 2n and n
    samples with n a tenth of the run, over 2 n dt, which is free of the constant.  Errors: standard
    error and jackknife over replicas.  Raises `ValueError` with fewer than 3 times or 2 replicas.
    """
    replicas, samples = positions.shape
    if samples < 3 or replicas < 2:
        raise ValueError(f"{replicas} replicas at {samples} times: need 2 replicas and 3 times")
    lag = max(1, (samples - 1) // 10)
    step = float(times[1] - times[0])
    travelled = positions[:, -1] - positions[:, 0]
    velocity = travelled / (times[-1] - times[0])
    sums = []  # displacement and its square at both lags, per replica
    for n in (lag, 2 * lag):
        moved = positions[:, n:] - positions[:, :-n]
        sums.append((moved.mean(axis=1), (moved**2).mean(axis=1)))

    def diffusion(keep: NDArray[np.bool_]) -> float:
        drift = velocity[keep].mean()
        variances = []
        for n, (first, second) in zip((lag, 2 * lag), sums, strict=True):
            mean = drift * n * step
            variances.append(float((second[keep] - 2 * mean * first[keep] + mean**2).mean()))
        return float((variances[1] - variances[0]) / (2 * lag * step))

    everyone = np.ones(replicas, dtype=bool)
    without = np.array([diffusion(np.arange(replicas) != i) for i in range(replicas)])
    spread = np.sqrt((replicas - 1) / replicas * ((without - without.mean()) ** 2).sum())
    return WalkEstimate(
        float(velocity.mean()),
        float(velocity.std(ddof=1) / np.sqrt(replicas)),
        diffusion(everyone),
        float(spread),
    )
