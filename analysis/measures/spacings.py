"""Spacings of neighbours in the chain, singly and in groups (tabatabaei-2009, Fig. 4.12)."""

from matplotlib.figure import Figure

from analysis import chain
from analysis.arrays import Array
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """Time means of the spacings, and the groups' history."""
    used = sampled_frames(run)
    spacings = chain.neighbour_spacings(chain.chain_of(run).x)
    groups = chain.group_spacings(spacings)
    entry = {
        "neighbours": spacings[used].mean(axis=0).tolist(),
        "groups_initial": groups[0].tolist(),
        "groups": groups[used].mean(axis=0).tolist(),
        "groups_final": groups[-1].tolist(),
        "left_out_at_tail": spacings.shape[1] % chain.GROUP,
    }
    pictures = {}
    if groups.shape[1]:
        times = run.times(run.particles().steps)
        pictures["spacings.png"] = draw(times, groups, run.equilibration_time)
    return Findings({"spacings": entry}, pictures)


def draw(times: Array, groups: Array, equilibration: float) -> Figure:
    """Mean spacings D_i(t) of the chain, as in Fig. 4.12.

    Args:
        times: (T,) [t0].
        groups: D_i, head first, (T, groups) [a0].
        equilibration: time averages leave out [t0].
    """
    figure, axes = one_panel(TIME, "mean spacing $D_i$ [$a_0$]")
    count = groups.shape[1]
    for group in range(count):
        end = {0: " (head)", count - 1: " (tail)"}.get(group, "") if count > 1 else ""
        axes.plot(times, groups[:, group], linewidth=1, label=f"$D_{{{group + 1}}}${end}")
    mark_equilibration(axes, equilibration)
    axes.legend(ncols=1 + count // 12)
    return figure
