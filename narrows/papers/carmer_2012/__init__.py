"""Figures of J. Carmer, F. van Swol and T. M. Truskett, diffusivity profiles by colours (2012).

| module | figures |
|---|---|
| `pores` | 1, D(z) by colours and by likelihood; 2, by reaction probability, with its inset |
| `pairs` | 3, D(r) in bulk |
| `profiles` | what a run says of D, for both |

Units: diameter, mass and kBT are 1.
"""

from lammps_inputs.engines.events import ENGINE
from narrows.papers.carmer_2012 import pairs, pores
from narrows.papers.figure import Paper

PAPER = Paper(
    "carmer-2012",
    "Carmer, van Swol and Truskett (2012): diffusivity profiles from colour reactions",
    (*pores.FIGURES, *pairs.FIGURES),
    engine=ENGINE.name,
    units="diameter = mass = kBT = 1",
)
