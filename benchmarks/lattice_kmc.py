"""Kinetic Monte Carlo of the lattice gases: speed against other ways, error against run time.

    python benchmarks/lattice_kmc.py [--gillespy2 PYTHON]

Speed: attempted updates and accepted events per second of processor time on one thread, on a chain
of 10^4 sites, of this package and of the same algorithm written straightforwardly in Python with
numpy random numbers.  With --gillespy2, the path of a Python that has GillesPy2 1.8 (its compiled
SSA solver), events per second on a chain of 50 sites too: it keeps a species per site and state and
a reaction per bond and rate, so longer chains cost it more per event.  Each comparison is made in
pairs, one after the other, repeated five times; medians are printed, with the smallest and
largest ratio.

Error: v_s and D_s of the shock from runs of growing length, with the wall time of each.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import time
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lattice import monte_carlo, shocks, spec
from lattice.models import LatticeGas

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples" / "lattice"
Array = NDArray[Any]

SEED = 1
REPEATS = 5

GILLESPY2 = """
import json, resource, sys
import gillespy2
model = json.load(sys.stdin)
class Chain(gillespy2.Model):
    def __init__(self):
        super().__init__(name="chain")
        sites, size = model["sites"], model["size"]
        names = [[f"s{k}n{n}" for n in range(size)] for k in range(sites)]
        self.add_species([gillespy2.Species(name=names[k][n], mode="discrete",
            initial_value=int(model["state"][k] == n)) for k in range(sites) for n in range(size)])
        species = self.listOfSpecies
        for i, (kind, final, initial, rate) in enumerate(model["moves"]):
            parameter = gillespy2.Parameter(name=f"w{i}", expression=rate)
            self.add_parameter(parameter)
            places = range(sites - 1) if kind == "bond" else [0 if kind == "left" else sites - 1]
            for k in places:
                reactants, products = {}, {}
                width = 2 if kind == "bond" else 1
                for offset in range(width):
                    a = initial // size ** (width - 1 - offset) % size
                    b = final // size ** (width - 1 - offset) % size
                    reactants[species[names[k + offset][a]]] = 1
                    products[species[names[k + offset][b]]] = 1
                self.add_reaction(gillespy2.Reaction(name=f"r{i}k{k}", reactants=reactants,
                    products=products, rate=parameter))
        self.timespan(gillespy2.TimeSpan.linspace(t=model["time"], num_points=2))
solver = gillespy2.SSACSolver(model=Chain())
solver.run(seed=1)  # compiles, not counted
for seed in range(model["repeats"]):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    solver.run(seed=seed + 1)
    print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, flush=True)
"""


def _ends(model: LatticeGas) -> tuple[Array, Array]:
    """The boundary generators of an open chain."""
    assert model.left is not None
    assert model.right is not None
    return model.left, model.right


def start_state(model: LatticeGas, sites: int, z: float) -> Array:
    """A draw of the product measure of z."""
    rng = np.random.default_rng(SEED)
    return rng.choice(model.size, size=sites, p=model.marginal(z)).astype(np.uint8)


def compiled(model: LatticeGas, state: Array, attempts: int) -> tuple[float, int]:
    """Seconds on one thread, and number of events, of this package's kernel."""
    tables = monte_carlo._tables(model)
    words = np.random.default_rng(SEED).integers(0, 2**64, 4, dtype=np.uint64)
    flux = np.zeros(state.size + 1, dtype=np.int64)
    clocks = state.size - 1 + sum(tables.clocks)
    start = time.thread_time()
    monte_carlo._advance(
        state,
        attempts,
        words,
        model.size,
        False,
        tables.clocks[0],
        clocks,
        tables.threshold,
        tables.target,
        tables.carried,
        flux,
    )
    return time.thread_time() - start, clocks


def straightforward(model: LatticeGas, state: Array, attempts: int) -> tuple[float, int]:
    """Seconds and events of the same algorithm in Python: numpy draws, then a loop."""
    rng = np.random.default_rng(SEED)
    s, sites = model.size, state.size
    ends = _ends(model)
    clock = float(-np.diag(model.bulk).min())
    clocks = [max(1, int(np.ceil(-np.diag(end).min() / clock))) for end in ends]

    def cumulative(matrix: Array, rate: float) -> list[list[float]]:
        chances = matrix / rate + np.eye(len(matrix))
        rows: list[list[float]] = np.cumsum(chances, axis=0).T.tolist()
        return rows

    bulk = cumulative(model.bulk, clock)
    left, right = (cumulative(end, clock * n) for end, n in zip(ends, clocks, strict=True))
    start = time.thread_time()
    picks = rng.integers(0, sites - 1 + sum(clocks), attempts) - clocks[0]
    draws = rng.random(attempts)
    configuration, events = state.tolist(), 0
    for pick, draw in zip(picks.tolist(), draws.tolist(), strict=True):
        if 0 <= pick < sites - 1:
            old = s * configuration[pick] + configuration[pick + 1]
            new = next(n for n, limit in enumerate(bulk[old]) if draw < limit or n == s * s - 1)
            if new != old:
                configuration[pick], configuration[pick + 1] = divmod(new, s)
                events += 1
        else:
            site, table = (0, left) if pick < 0 else (sites - 1, right)
            old = configuration[site]
            new = next(n for n, limit in enumerate(table[old]) if draw < limit or n == s - 1)
            if new != old:
                configuration[site] = new
                events += 1
    return time.thread_time() - start, events


def event_rate(model: LatticeGas, sites: int, z: float) -> float:
    """Events per unit of time in the product measure of z."""
    p = model.marginal(z)
    pair = np.kron(p, p)
    ends = sum(float(-np.diag(end) @ p) for end in _ends(model))
    return (sites - 1) * float(-np.diag(model.bulk) @ pair) + ends


def speed(name: str, model: LatticeGas, z: float, sites: int = 10_000) -> None:
    """This package against straightforward Python, in pairs."""
    state = start_state(model, sites, z)
    compiled(model, state.copy(), 1000)  # compiles
    rates: list[tuple[float, float]] = []
    share = 0.0
    for _ in range(REPEATS):
        fast, _clocks = compiled(model, state.copy(), 20_000_000)
        slow, events = straightforward(model, state.copy(), 300_000)
        rates.append((20_000_000 / fast, 300_000 / slow))
        share = events / 300_000
    ratios = [a / b for a, b in rates]
    print(
        f"{name:16s} this package {median(a for a, _ in rates):.3g} attempts/s "
        f"({share * median(a for a, _ in rates):.3g} events/s), Python "
        f"{median(b for _, b in rates):.3g} attempts/s, ratio {median(ratios):.0f} "
        f"({min(ratios):.0f} to {max(ratios):.0f})",
        flush=True,
    )


def against_gillespy2(
    python: str, name: str, model: LatticeGas, z1: float, z2: float, sites: int = 50
) -> None:
    """This package against GillesPy2's compiled direct method on the same chain."""
    model = model.with_reservoirs(z1, z1)  # stationary from the start, so that events are known
    state = start_state(model, sites, z1)
    duration = 2000.0
    moves = []
    left, right = _ends(model)
    for kind, matrix in (("bond", model.bulk), ("left", left), ("right", right)):
        for final, initial in np.argwhere(matrix > 0).tolist():
            moves.append((kind, final, initial, float(matrix[final, initial])))
    data = {
        "sites": sites,
        "size": model.size,
        "state": state.tolist(),
        "moves": moves,
        "time": duration,
        "repeats": REPEATS,
    }
    events = event_rate(model, sites, z1) * duration
    # GillesPy2 starts its build with the base interpreter, which must find the venv's SCons
    where = [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    packages = subprocess.run(where, capture_output=True, text=True, check=True).stdout.strip()
    process = subprocess.Popen(
        [python, "-c", GILLESPY2],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": packages},
    )
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(data))
    process.stdin.close()
    tables = monte_carlo._tables(model)
    attempts = int(duration * tables.clock * (sites - 1 + sum(tables.clocks)))
    compiled(model, state.copy(), 1000)  # compiles, not counted
    theirs, ours = [], []
    for line in process.stdout:
        theirs.append(float(line))
        ours.append(compiled(model, state.copy(), attempts)[0])
    ratios = [a / b for a, b in zip(theirs, ours, strict=True)]
    print(
        f"{name:16s} L = {sites}: this package {events / median(ours):.3g} events/s, GillesPy2 "
        f"{events / median(theirs):.3g} events/s, ratio {median(ratios):.0f} "
        f"({min(ratios):.0f} to {max(ratios):.0f})",
        flush=True,
    )


def accuracy(name: str, model: LatticeGas, z1: float, z2: float, sites: int = 4000) -> None:
    """v_s and D_s with errors, and the wall time on all cores, for growing numbers of replicas."""
    d1, d2 = shocks.hopping_rates(model, z1, z2)
    initial = shocks.shock_marginals(model, sites, sites // 2, z1, z2)
    evidence = monte_carlo.shock_evidence(model, z1, z2)
    times = np.linspace(0.0, 300.0, 31)
    print(f"{name}: exact v_s = {d2 - d1:.5f}, D_s = {(d1 + d2) / 2:.5f}; L = {sites}, t = 300")
    for replicas in (10, 40, 160):
        start = time.perf_counter()
        run = monte_carlo.simulate(model, initial, times, replicas, SEED, evidence)
        seconds = time.perf_counter() - start
        assert run.positions is not None
        found = monte_carlo.estimate_walk(times, run.positions)
        print(
            f"  {replicas:4d} replicas {seconds:7.2f} s {run.attempts / seconds:.3g} attempts/s: "
            f"v_s = {found.velocity:.5f} +- {found.velocity_error:.5f}, "
            f"D_s = {found.diffusion:.4f} +- {found.diffusion_error:.4f}",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gillespy2", metavar="PYTHON")
    arguments = parser.parse_args()
    models = {path.stem: spec.read(path) for path in sorted(EXAMPLES.glob("*.toml"))}
    for name, (model, z1, _z2) in models.items():
        speed(name, model, z1)
    if arguments.gillespy2:
        for name in ("two_sided", "internal_state"):
            against_gillespy2(arguments.gillespy2, name, *models[name])
    for name in ("one_sided", "two_sided", "internal_state"):
        accuracy(name, *models[name])


if __name__ == "__main__":
    main()
