"""The names under which older modules know means and their errors."""

from analysis.correlated_mean import mean, ratio
from analysis.estimate import Estimate, mean_of_independent

__all__ = ["Estimate", "mean", "mean_of_independent", "ratio", "root"]

root = Estimate.sqrt
