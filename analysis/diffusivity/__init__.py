"""Diffusivity profiles of any trajectory, by colours, by likelihood and by first passage.

Each is an MDAnalysis analysis of a `Coordinate`: a position across a slit or channel, or the
distance from central particles. docs/diffusivity.md says when to use which.
"""

from analysis.diffusivity.bayes import BayesianDiffusivity
from analysis.diffusivity.color import ColorDiffusivity, color_diffusivity
from analysis.diffusivity.coordinates import AlongAxis, Coordinate, PairDistance, Recorded
from analysis.diffusivity.displacement import MiddleDiffusivity
from analysis.diffusivity.errors import DiffusivityError
from analysis.diffusivity.first_passage import FirstPassageDiffusivity

__all__ = [
    "AlongAxis",
    "BayesianDiffusivity",
    "ColorDiffusivity",
    "Coordinate",
    "DiffusivityError",
    "FirstPassageDiffusivity",
    "MiddleDiffusivity",
    "PairDistance",
    "Recorded",
    "color_diffusivity",
]
