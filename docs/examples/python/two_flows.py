"""The flow about a settling colloid, with and without hydrodynamics, in colours of one scale.

python two_flows.py RUN_WITH RUN_WITHOUT PICTURE
"""

import sys

import matplotlib.pyplot as plt

from narrows import RunDirectory, draw_flow

*folders, picture = sys.argv[1:]
figure, panels = plt.subplots(2, 1, figsize=(9, 5.4), layout="constrained")
for axes, folder, title in zip(panels, folders, ("with", "without"), strict=True):
    run = RunDirectory(folder)
    field = run.field()
    flow = field.mean(run.flow_used(field))
    mesh = draw_flow(axes, flow, radius=run.species().radius, fastest=0.12)
    axes.set_title(f"{title} hydrodynamics")
figure.colorbar(mesh, ax=panels, label="speed of the fluid [$a_0/t_0$]", shrink=0.8)
figure.savefig(picture, dpi=100)
