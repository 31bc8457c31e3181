"""What each figure of an analysis shows, for readers of a report who may not see it."""

CAPTIONS = {
    "clusters.png": "Size of the largest cluster and number of clusters against time.",
    "colour_flow.png": "Density and velocity of each colour across the field.",
    "diffusion.png": "Mean squared displacement about the mean drift against the lag, with the "
    "line that the diffusion coefficient is taken from.",
    "diffusivity.png": "Diffusivity profile for each reaction probability, with error bars.",
    "flow.png": "Mean flow of the fluid: stream lines over its speed, by colour.",
    "lane_order.png": "Order parameter of lanes against time.",
    "pair_correlation.png": "Pair correlation of the colloids along the channel.",
    "path_diffusivity.png": "Diffusivity profile of the trajectory by each estimator, with errors.",
    "profile.png": "Velocity of the fluid across the slit, mean over time with error bars.",
    "radial_distribution.png": "Radial distribution function of the colloids.",
    "reacted_speeds.png": "Normal speeds of the particles that reacted, beside equilibrium.",
    "rotational_diffusion.png": "Mean squared angle that colloids rotate by against the lag, and "
    "the diffusion coefficient by where its sum ends.",
    "settling_speed.png": "Settling speed against time, running means in both frames.",
    "shear_flow.png": "Velocity of the colloids between the moving walls.",
    "shear_wave.png": "Amplitude of the shear wave against time, with the fitted decay.",
    "snapshot.png": "The particles in their box at the last output; of a single species the head "
    "of the chain is dark, the tail light, else each species has a colour.",
    "space_time.png": "Place of every colloid along the channel against time.",
    "spacings.png": "Mean spacings of neighbours, in groups from head to tail, against time.",
    "suspension.png": "The colloids at the last output, clusters by colour.",
    "velocity_distribution.png": "Velocities of the colloids beside a normal distribution.",
    "zigzag.png": "Zigzag of the chain against time, of the whole and about each colloid.",
}


def caption(figure: str) -> str:
    """What the figure of a file name shows; its name for one that is not known."""
    return CAPTIONS.get(figure, figure.removesuffix(".png").replace("_", " "))
