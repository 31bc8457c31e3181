"""Three-state lattice gases: exact, simulated and hydrodynamic shocks (Tabatabaei 2009, chapter 2).

| module | holds |
|---|---|
| `models` | the charge, internal-state and ASEP families, boundaries, reservoirs |
| `generator` | exact engine: sparse and matrix-free generator, stationary state, evolution |
| `shocks` | conditions and residuals, d1, d2, end rates, the walk of the shock |
| `completion` | partial rates completed to a model on the shock manifold |
| `check` | all of that for one model at once |
| `monte_carlo` | continuous-time Monte Carlo, shock position, v_s and D_s |
| `hydrodynamics`, `step` | j(u), Godunov, Riemann, phases, domain walls; the step compared |
| `matrix_product` | stationary ASEP up to L of order 10^3 |
| `spec` | models from TOML or JSON files |
| `figures` | PNG figures |
"""
