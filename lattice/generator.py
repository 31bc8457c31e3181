"""Exact engine: the full generator W = -H (2.17) of a chain of L sites, and what follows from it.

A configuration n_1..n_L has the index sum_k n_k s^(L-k): site 1 is the slowest digit, as in the
tensor products of (2.20).  The generator is a sum of bond and boundary terms, each a Kronecker
product with identities, so it is assembled without visiting configurations one by one, and it is
applied to a vector without being stored at all.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse, stats
from scipy.sparse import csgraph
from scipy.sparse.linalg import LinearOperator

from lattice.models import LatticeGas, Vector

#: Up to this many configurations the stationary state is solved by dense LU (seconds, 40 MB).
_DENSE = 3**7
#: Krylov vectors kept between restarts of GMRES.
_RESTART = 40
#: Restarts before giving up.
_CYCLES = 300


YEAR = 365 * 86400.0  # seconds


class TooLarge(ValueError):
    """What does not fit the memory, or would take a year; the message has the bytes or the time."""


class NoUniqueState(ValueError):
    """More than one stationary state can be reached from the given initial measure."""


class NotConverged(RuntimeError):
    """The iteration for the stationary state stopped before the residual asked for."""


def _terms(model: LatticeGas, sites: int) -> Iterator[tuple[int, Vector]]:
    """(first site from 0, local generator) of each term of (2.17) that is no wrapping bond."""
    if model.left is not None and model.right is not None:
        yield 0, model.left
        yield sites - 1, model.right
    for bond in range(sites - 1):
        yield bond, model.bulk


def count_states(model: LatticeGas, sites: int) -> float:
    """s^L, infinite where no float holds it."""
    return math.inf if sites * math.log(model.size) > 700 else float(model.size) ** sites


def available_bytes() -> int:
    """Physical memory free for use, in bytes."""
    return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def require_memory(needed: float, what: str) -> None:
    """Raise `TooLarge`, with the number of bytes, if `needed` exceeds the memory available."""
    available = available_bytes()
    if needed > available:
        raise TooLarge(f"{what} needs {needed:.3g} bytes of memory, {available:.3g} are available")


def require_vectors(count: int, model: LatticeGas, sites: int) -> None:
    """Raise `TooLarge` if so many vectors of all configurations do not fit the memory."""
    states = count_states(model, sites)
    if math.isinf(states):
        digits = math.log10(8 * count) + sites * math.log10(model.size)
        raise TooLarge(f"vectors of L = {sites} sites need 1e{digits:.0f} bytes of memory")
    require_memory(8.0 * count * states, f"vectors of L = {sites} sites")


def require_time(operations: float, per_second: float, what: str) -> None:
    """Raise `TooLarge`, with the time it would take, if that is more than a year."""
    years = operations / per_second / YEAR
    if not years <= 1:
        raise TooLarge(f"{what} would take {years:.3g} years")


def _check_sites(sites: int) -> None:
    if sites < 2:
        raise ValueError(f"L = {sites}: a chain has at least 2 sites")


def matrix_bytes(model: LatticeGas, sites: int) -> float:
    """Memory in bytes to assemble the stored generator of `sites` sites (CSR, 3 copies)."""
    s = model.size
    per_state = 1.0 + (sites - 1) * np.count_nonzero(model.bulk) / s**2
    if model.left is not None and model.right is not None:
        per_state += (np.count_nonzero(model.left) + np.count_nonzero(model.right)) / s
    return 3 * 12 * per_state * count_states(model, sites)


def generator(model: LatticeGas, sites: int) -> sparse.csr_array:
    """Stored sparse generator, shape (s^L, s^L); columns are initial states and add up to zero.

    Raises `TooLarge`.
    """
    _check_sites(sites)
    require_memory(matrix_bytes(model, sites), f"the stored generator at L = {sites}")
    s = model.size

    def widen(local: Any, first: int) -> Any:
        span = round(np.log(local.shape[0]) / np.log(s))
        before, after = s**first, s ** (sites - first - span)
        wide = sparse.kron(sparse.eye_array(before), local, format="csr")
        return sparse.kron(wide, sparse.eye_array(after), format="csr")

    total = sparse.csr_array((s**sites, s**sites))
    for first, local in _terms(model, sites):
        total = total + widen(sparse.csr_array(local), first)
    if model.periodic:
        total = total + _wrapping_bond(model, sites)
    return total


def _wrapping_bond(model: LatticeGas, sites: int) -> sparse.csr_array:
    """Bond (L, 1) of a ring: sum over its transitions of (site 1) x identity x (site L)."""
    s = model.size
    middle = sparse.eye_array(s ** (sites - 2))
    total = sparse.csr_array((s**sites, s**sites))
    blocks = model.bulk.reshape(s, s, s, s)  # (final L, final 1, initial L, initial 1)
    for final, initial in np.ndindex(s, s):
        first = sparse.csr_array(([1.0], ([final], [initial])), shape=(s, s))
        last = sparse.csr_array(blocks[:, final, :, initial])
        if last.nnz:
            wide = sparse.kron(first, middle, format="csr")
            total = total + sparse.kron(wide, last, format="csr")
    return total


def _moves(local: Vector) -> list[tuple[int, int, float]]:
    return [(int(i), int(j), float(local[i, j])) for i, j in np.argwhere(local)]


def apply(model: LatticeGas, sites: int, vector: Vector) -> Vector:
    """W|v> without storing W: each local term acts on its digits of the index, shape (s^L,)."""
    s = model.size
    result = np.zeros(s**sites)
    for first, local in _terms(model, sites):
        width = local.shape[0]
        source = vector.reshape(s**first, width, -1)
        target = result.reshape(s**first, width, -1)
        for final, initial, rate in _moves(local):
            target[:, final] += rate * source[:, initial]
    if model.periodic:
        source = vector.reshape(s, -1, s)
        target = result.reshape(s, -1, s)
        for final, initial, rate in _moves(model.bulk):
            (last, one), (last0, one0) = divmod(final, s), divmod(initial, s)
            target[one, :, last] += rate * source[one0, :, last0]
    return result


def operator(model: LatticeGas, sites: int) -> LinearOperator[np.float64]:
    """Matrix-free generator for L beyond what a stored matrix allows; raises `TooLarge`."""
    _check_sites(sites)
    require_vectors(4, model, sites)
    shape = (model.size**sites,) * 2
    return LinearOperator(shape, matvec=lambda v: apply(model, sites, v.ravel()), dtype=np.float64)


def product_vector(marginals: Iterable[Vector]) -> Vector:
    """Tensor product (2.20) of single-site probabilities given site by site, shape (s^L,)."""
    vector: Vector = np.ones(1)
    for marginal in marginals:
        vector = np.asarray(np.kron(vector, marginal))
    return vector


def exit_rate(model: LatticeGas, sites: int) -> float:
    """Bound on the total rate out of any configuration, the diagonal of -W."""
    bonds = sites if model.periodic else sites - 1
    bound = bonds * float(-np.diag(model.bulk).min())
    for end in (model.left, model.right):
        bound += 0.0 if end is None else float(-np.diag(end).min())
    return bound


def evolve(model: LatticeGas, sites: int, initial: Vector, times: Iterable[float]) -> Vector:
    """exp(W t)|P(0)> (2.16) at increasing `times`, shape (number of times, s^L).

    Uniformisation: exp(W t) = sum_n Poisson(n; R t) (1 + W/R)^n, R the bound on exit rates.  Every
    term is nonnegative, so no cancellation occurs, and the sum is cut
    where the Poisson weights left out add up to less than 1e-17.  Matrix-free.
    Raises `TooLarge`, `ValueError`.
    """
    moments = [float(t) for t in times]
    if any(b < a for a, b in zip([0.0, *moments], moments, strict=False)):
        raise ValueError(f"times {moments}: must be increasing and not negative")
    require_memory((4.0 + len(moments)) * 8 * initial.size, f"evolution of L = {sites} sites")
    bound = exit_rate(model, sites)
    terms = bound * max(moments, default=0.0)
    require_memory(8 * 2 * terms, f"evolution to time {max(moments, default=0.0):g}")
    require_time(terms * initial.size, 1e8, f"evolution to time {max(moments, default=0.0):g}")
    result = np.empty((len(moments), initial.size))
    state, now = initial, 0.0
    for row, time in enumerate(moments):
        mean = bound * (time - now)
        last = int(mean + 10 * np.sqrt(mean) + 40) if mean > 0 else 0  # ten standard deviations
        weights = stats.poisson.pmf(np.arange(last + 1), mean)
        term, total = state, weights[0] * state
        for weight in weights[1:]:
            term = term + apply(model, sites, term) / bound
            total = total + weight * term
        state, now = total, time
        result[row] = state
    return result


def _reachable(matrix: sparse.csr_array, start: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Configurations that can be reached from those of `start`."""
    ones = np.ones(matrix.nnz, np.int32)
    links = sparse.csr_array((ones, matrix.indices, matrix.indptr), shape=matrix.shape)
    reached = start
    while True:
        wider = reached | (links @ reached.astype(np.int32) > 0)
        if (wider == reached).all():
            return reached
        reached = wider


def _closed_classes(matrix: sparse.csr_array) -> int:
    """Number of sets of configurations that are never left (one stationary state each)."""
    count, label = csgraph.connected_components(matrix, directed=True, connection="strong")
    edges = matrix.tocoo()
    left = label[edges.col[label[edges.col] != label[edges.row]]]
    return int(count - np.unique(left).size)


def stationary_state(
    model: LatticeGas,
    sites: int,
    start: Vector | None = None,
    tolerance: float = 1e-12,
    stored: bool | None = None,
) -> Vector:
    """Stationary distribution |P*> of W|P*> = 0 (2.22), shape (s^L,), reached from `start`.

    With the summation vector <s| and any distribution |u>, (W - R|u><s|)|P> = -R|u> has the unique
    solution W|P> = 0, <s|P> = 1: it is solved by LU for small chains and by GMRES for large ones
    until |W P|_1 < `tolerance` times the exit rate R.  `start` (default: all configurations)
    restricts the state space to what it can reach; with a stored matrix more than one closed class
    there raises `NoUniqueState`.  `stored` chooses between matrix and matrix-free (default:
    by memory); matrix-free uses the whole space and does not count classes.
    Raises `TooLarge`, `NoUniqueState`, `NotConverged`.
    """
    _check_sites(sites)
    count = model.size**sites
    krylov = (_RESTART + 10.0) * 8 * count
    if stored is None:
        stored = matrix_bytes(model, sites) + krylov < available_bytes()
    require_memory(krylov, f"the stationary state at L = {sites}")
    bound = exit_rate(model, sites)
    if not stored:
        guess = np.full(count, 1 / count) if start is None else start
        return _solve(lambda v: apply(model, sites, v), guess, bound, tolerance)

    matrix = generator(model, sites)
    support = np.ones(count, dtype=bool) if start is None else _reachable(matrix, start > 0)
    if not support.all():
        kept = np.flatnonzero(support)
        matrix = sparse.csr_array(matrix[kept][:, kept])
    classes = _closed_classes(matrix)
    if classes > 1:
        raise NoUniqueState(
            f"{classes} stationary states at L = {sites}: the rates leave {classes} sets of "
            "configurations closed (a conserved number, or several frozen configurations)"
        )
    guess = np.full(count, 1 / count) if start is None else start
    inside = guess[support] / guess[support].sum()
    result = np.zeros(count)
    if inside.size <= _DENSE:
        dense = matrix.toarray() - bound * inside[:, None]
        result[support] = np.linalg.solve(dense, -bound * inside)
    else:
        result[support] = _solve(lambda v: matrix @ v, inside, bound, tolerance)
    return result


def _solve(product: Any, start: Vector, bound: float, tolerance: float) -> Vector:
    """Null vector of W by restarted GMRES on (W - R|u><s|)|P> = -R|u>, |u> = `start`.

    Orthogonalises against all basis vectors at once (classical Gram-Schmidt, twice), with einsum:
    on a busy machine threaded BLAS is tens of times slower here, waiting for its threads.
    """

    def shifted(v: Vector) -> Vector:
        return np.asarray(product(v) - bound * start * v.sum())

    state, residual = start, np.inf
    basis = np.empty((_RESTART + 1, start.size))
    for _ in range(_CYCLES):
        rest = -bound * start - shifted(state)
        length = np.sqrt((rest * rest).sum())
        basis[0] = rest / length
        hessenberg = np.zeros((_RESTART + 1, _RESTART))
        for j in range(_RESTART):
            vector = shifted(basis[j])
            for _pass in range(2):
                overlap = np.einsum("ij,j->i", basis[: j + 1], vector)
                vector -= np.einsum("i,ij->j", overlap, basis[: j + 1])
                hessenberg[: j + 1, j] += overlap
            hessenberg[j + 1, j] = np.sqrt((vector * vector).sum())
            if hessenberg[j + 1, j] < 1e-14 * bound:  # the Krylov space is invariant: solved
                break
            basis[j + 1] = vector / hessenberg[j + 1, j]
        target = np.zeros(j + 2)
        target[0] = length
        weights = np.linalg.lstsq(hessenberg[: j + 2, : j + 1], target, rcond=None)[0]
        state = state + weights @ basis[: j + 1]
        state = state / state.sum()
        residual = float(np.abs(product(state)).sum())
        if residual < tolerance * bound:
            return np.asarray(state)
    raise NotConverged(
        f"stationary state: |W P|_1 = {residual:.2e} after {_CYCLES * _RESTART} applications"
    )


def site_probabilities(model: LatticeGas, sites: int, state: Vector) -> Vector:
    """Probability of each state at each site, shape (L, s)."""
    s = model.size
    return np.array([state.reshape(s**k, s, -1).sum(axis=(0, 2)) for k in range(sites)])


def pair_probabilities(model: LatticeGas, sites: int, state: Vector) -> Vector:
    """Probability of each pair state (2.1) at each bond (k, k+1), shape (L - 1, s^2)."""
    s = model.size
    return np.array([state.reshape(s**k, s * s, -1).sum(axis=(0, 2)) for k in range(sites - 1)])


def bond_currents(model: LatticeGas, sites: int, state: Vector) -> Vector:
    """Current of the conserved quantity over each bond, shape (L - 1,): (2.46) or (2.125)."""
    return np.asarray(pair_probabilities(model, sites, state) @ model.bond_current())


def species_currents(model: LatticeGas, sites: int, state: Vector) -> dict[str, Vector]:
    """Currents of A and of B over each bond, each of shape (L - 1,).

    Where C moves, a change of species is shared equally between the two sites; where it does not,
    an exchange AB <-> BA carries both species and any other conversion none.  This is the
    convention of (2.52), (2.53), (2.123) and (2.124).
    """
    s = model.size
    pairs = pair_probabilities(model, sites, state)
    moves_c = np.subtract.outer(np.repeat(model.conserved, s), np.repeat(model.conserved, s)) != 0
    mirror = np.arange(s * s).reshape(s, s).T.ravel()
    counted = moves_c | np.eye(s * s, dtype=bool)[mirror]
    currents = {}
    for name in ("A", "B")[: s - 1]:
        present = np.array([float(label == name) for label in model.states])
        difference = (np.tile(present, s) - np.repeat(present, s)) / 2  # right minus left, halved
        carried = np.subtract.outer(difference, difference)  # of final and initial pair
        currents[name] = np.asarray(
            pairs @ (np.where(counted, carried, 0) * model.bulk).sum(axis=0)
        )
    return currents


def connected_correlation(
    model: LatticeGas, sites: int, state: Vector, observable: Vector | None = None
) -> Vector:
    """<O_k O_l> - <O_k><O_l> of a one-site observable (default: C(n)), shape (L, L)."""
    s = model.size
    values = model.conserved if observable is None else observable
    single = site_probabilities(model, sites, state)
    mean = single @ values
    result = np.diag(single @ values**2) - np.outer(mean, mean)
    for k in range(sites):
        for m in range(k + 1, sites):
            joint = state.reshape(s**k, s, s ** (m - k - 1), s, -1).sum(axis=(0, 2, 4))
            result[k, m] += values @ joint @ values
            result[m, k] = result[k, m]
    return np.asarray(result)
