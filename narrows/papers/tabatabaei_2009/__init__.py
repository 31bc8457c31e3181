"""Figures of S. Tabatabaei's thesis on colloids in a narrow channel (2009).

| module | figures |
|---|---|
| `lattice_shocks` | 2.1 and 2.2, with a running shock |
| `flow` | 3.6 and 3.7, Poiseuille flow |
| `few_colloids` | 4.3 to 4.5 and 4.8, settling speed against volume fraction and length |
| `many_colloids` | 4.6, 4.7 and 5.1, against volume fraction, number and density |
| `field` | 4.9 and 4.10, against gravity |
| `chain_release` | 4.12 to 4.14, the released chain |
| `beyond_flux`, `beyond_front` with `chain_ends` | what the thesis could not do: docs/beyond.md |

Units: a0 = kBT = m_f = 1.
"""

from lammps_inputs.engines import DEFAULT
from narrows.papers.figure import Paper
from narrows.papers.tabatabaei_2009 import (
    beyond_flux,
    beyond_front,
    chain_release,
    few_colloids,
    field,
    flow,
    lattice_shocks,
    many_colloids,
)

_FIGURES = (
    *lattice_shocks.FIGURES,
    *flow.FIGURES,
    *few_colloids.FIGURES,
    *many_colloids.FIGURES,
    *field.FIGURES,
    *chain_release.FIGURES,
)

PAPER = Paper(
    "tabatabaei-2009",
    "Tabatabaei (2009): shocks of lattice gases, and colloids in a narrow channel",
    (
        *sorted(_FIGURES, key=lambda figure: [int(part) for part in figure.number.split(".")]),
        *beyond_flux.FIGURES,
        *beyond_front.FIGURES,
    ),
    engine=DEFAULT,
    units="a0 = kBT = m_f = 1, t0 = a0 sqrt(m_f / kBT)",
)
