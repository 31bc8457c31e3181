"""Sixfold bond-orientational order of disks."""

from analysis import correlated_mean
from analysis.bond_order import bond_order
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("bond_order", "bond_order_local")


def measure(run: RunDirectory) -> Findings:
    """Means over time: the modulus of the mean over particles, and the mean of their moduli."""
    positions = run.particles().positions[sampled_frames(run)]
    order = bond_order(positions, run.box.sizes)
    return Findings(
        {
            "bond_order": correlated_mean.mean(order.mean).as_json(),
            "bond_order_local": correlated_mean.mean(order.mean_modulus).as_json(),
        }
    )
