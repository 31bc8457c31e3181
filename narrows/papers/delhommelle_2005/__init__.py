"""Figures of J. Delhommelle, Phys. Rev. E 71, 016705 (2005): lanes by the noise that is assumed.

| module | figures |
|---|---|
| `state_points` | the runs, and the numbers of their summaries |
| `color_field` | 1 to 8, soft disks in a colour field under two thermostats |
| `three_dimensions` | 9 to 11, spheres under four thermostats, and sheared |
| `hydrodynamic_noise` | beyond: the same question in an MPC fluid |
| `hysteresis` | beyond: the ladder of fields down again |

Units: sigma = epsilon = m = 1.
"""

from collections.abc import Sequence

from lammps_inputs import Scene
from narrows.papers.delhommelle_2005 import (
    color_field,
    hydrodynamic_noise,
    hysteresis,
    three_dimensions,
)
from narrows.papers.figure import Paper, Quality


def _ladders(quality: Quality) -> Sequence[Sequence[Scene]]:
    return [
        *color_field.ladders(quality),
        *three_dimensions.ladders(quality),
        *hysteresis.ladders(quality),
    ]


PAPER = Paper(
    "delhommelle-2005",
    "Delhommelle (2005): lane formation in driven liquids by the thermostat",
    (
        *color_field.FIGURES,
        *three_dimensions.FIGURES,
        *hydrodynamic_noise.FIGURES,
        *hysteresis.FIGURES,
    ),
    engine=None,
    units="sigma = epsilon = m = 1 of the pair potential",
    ladders=_ladders,
)
