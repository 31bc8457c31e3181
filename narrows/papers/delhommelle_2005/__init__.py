"""Figures of J. Delhommelle, Phys. Rev. E 71, 016705 (2005): lanes by the noise that is assumed.

| module | figures |
|---|---|
| `state_points` | the runs, and the numbers of their summaries |
| `color_field` | 1 to 8, soft disks in a colour field under two thermostats |
| `three_dimensions` | 9 to 11, spheres under four thermostats, and sheared |
| `hydrodynamic_noise` | beyond: the same question in an MPC fluid |

Units: sigma = epsilon = m = 1.
"""

from narrows.papers.delhommelle_2005 import color_field, hydrodynamic_noise, three_dimensions
from narrows.papers.figure import Paper

PAPER = Paper(
    "delhommelle-2005",
    "Delhommelle (2005): lane formation in driven liquids by the thermostat",
    (*color_field.FIGURES, *three_dimensions.FIGURES, *hydrodynamic_noise.FIGURES),
    engine=None,
    units="sigma = epsilon = m = 1 of the pair potential",
)
