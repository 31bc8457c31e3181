"""Cost of the exact engine against the number of sites.

    python benchmarks/lattice_exact.py [LARGEST]

For each length up to LARGEST (default 12) and one model of each family, off its shock manifold so
that the stationary state is no mixture of a few shock measures: bytes and seconds of the stored
generator, seconds of one application stored and matrix-free, of the stationary state (with its
residual |W P|_1 over the exit rate) and of the evolution to t = 1.  Wall-clock seconds.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from lattice import generator, shocks, spec

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples" / "lattice"


def main() -> None:
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else 12
    print(
        "model           L  states  stored/B  build/s  apply/s  free/s  stationary/s residual t=1/s"
    )
    for name in ("two_sided", "internal_state"):
        model, z1, z2 = spec.read(EXAMPLES / f"{name}.toml")
        bulk = model.bulk.copy()  # w37 grows by a half
        bulk[2, 6] += 0.5
        bulk[6, 6] -= 0.5
        model = replace(model, bulk=bulk)
        for sites in range(6, largest + 1):
            clock = time.perf_counter
            start = clock()
            matrix = generator.generator(model, sites)
            build = clock() - start
            stored_bytes = matrix.data.nbytes + matrix.indices.nbytes + matrix.indptr.nbytes
            vector = shocks.shock_vector(model, sites, sites // 2, z1, z2)
            start = clock()
            matrix @ vector
            apply_stored = clock() - start
            del matrix
            start = clock()
            generator.apply(model, sites, vector)
            apply_free = clock() - start
            start = clock()
            state = generator.stationary_state(model, sites)
            stationary = clock() - start
            flow = np.abs(generator.apply(model, sites, state)).sum()
            residual = flow / generator.exit_rate(model, sites)
            start = clock()
            generator.evolve(model, sites, vector, [1.0])
            evolution = clock() - start
            print(
                f"{name:14s} {sites:2d} {3**sites:8d} {stored_bytes:9.2e} {build:8.3f} "
                f"{apply_stored:8.5f} {apply_free:7.4f} {stationary:13.3f} {residual:9.1e} "
                f"{evolution:6.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
