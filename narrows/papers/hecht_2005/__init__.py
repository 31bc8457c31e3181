"""Tables and figures of M. Hecht et al., Simulation of claylike colloids (2005).

| module | figures |
|---|---|
| `laboratory` | Tables I to IV and the numbers of section VII |
| `potentials` | 1, the DLVO potentials |
| `settling` | 3 and 4, diffusion and the settling speed against the volume fraction |
| `structure` | 5 to 7, g(r) of clusters and of a suspension |
| `motion` | 8 and 14, velocities under shear, diffusion among growing clusters |
| `phases` | 9 to 13, where colloids cluster |
| `beyond_boundary` | beyond: where that begins, as a curve |
| `beyond_growth` | beyond: clusters in time with and without hydrodynamics |
| `beyond_diffusion` | beyond: D by potential and volume fraction, and what moves (X D) |
| `beyond_size` | beyond: ten times the suspension |

Runs are coupling II with R = 0.25 um, a0 = 0.4 um, M = 60 in (6 um)^3. Units: a0 = kBT = m_f = 1.
"""

from lammps_inputs.engines import DEFAULT
from narrows.papers.figure import Paper
from narrows.papers.hecht_2005 import (
    beyond_boundary,
    beyond_diffusion,
    beyond_growth,
    beyond_size,
    laboratory,
    motion,
    phases,
    potentials,
    settling,
    structure,
)

PAPER = Paper(
    "hecht-2005",
    "Hecht et al. (2005): claylike colloids",
    (
        *laboratory.FIGURES,
        *potentials.FIGURES,
        *settling.FIGURES,
        *structure.FIGURES,
        *motion.SHEAR,
        *phases.FIGURES,
        *motion.SLOWING,
        *beyond_boundary.FIGURES,
        *beyond_growth.FIGURES,
        *beyond_diffusion.FIGURES,
        *beyond_size.FIGURES,
    ),
    engine=DEFAULT,
    units="a0 = kBT = m_f = 1, t0 = a0 sqrt(m_f / kBT); SI where it says so",
    ladders=beyond_boundary.ladders,
)
