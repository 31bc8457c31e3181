"""Figures of J. Carmer, F. van Swol and T. M. Truskett, diffusivity profiles by colours (2012).

| module | figures |
|---|---|
| `pores` | 1, D(z) by colours and by likelihood; 2, by reaction probability, with its inset |
| `pairs` | 3, D(r) in bulk |
| `channel` | beyond-channel, D(y) of a colloid in our channel, with and without hydrodynamics |
| `clay` | beyond-clay, a tracer in a claylike suspension between walls |
| `profiles` | what a run says of D, for both |

Units: of hard spheres, diameter, mass and kBT are 1; beyond them the units of the scene.
"""

from narrows.papers.carmer_2012 import channel, clay, pairs, pores
from narrows.papers.figure import Paper

PAPER = Paper(
    "carmer-2012",
    "Carmer, van Swol and Truskett (2012): diffusivity profiles from colour reactions",
    (*pores.FIGURES, *pairs.FIGURES, *channel.FIGURES, *clay.FIGURES),
    engine=None,
    units="diameter = mass = kBT = 1; beyond hard spheres a0 = m_f = kBT = 1",
)
