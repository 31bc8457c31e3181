"""What an engine of events writes: averages of the spheres, and what their colours do.

Columns of colours are one for each reaction probability, numbered from 1: those of `labels`, A or B
by lot, and of `chances`, the probability to be A given the trajectory.
"""

from lammps_inputs.system import Output

EVENT_AVERAGES = Output(
    "observables.dat", "table", ("temperature", "collision_rate", "compressibility")
)
SLIT_EVENT_AVERAGES = Output(
    "observables.dat", "table", (*EVENT_AVERAGES.columns, "lower_pressure", "upper_pressure")
)


def color_outputs(kinds: int) -> tuple[Output, Output, Output]:
    """Profiles of colours, reactions at the two surfaces, and the speeds of what reacted.

    Args:
        kinds: how many reaction probabilities there are.
    """
    return (
        Output(
            "colors.dat",
            "profile",
            (
                *("Coord1", "Ncount"),
                *_each(kinds, "labels", "chances", "label_current", "chance_current"),
            ),
        ),
        Output(
            "reactions.dat",
            "table",
            (
                *("first_hits", "second_hits"),
                *_each(kinds, "first_labels", "first_chances", "second_labels", "second_chances"),
            ),
        ),
        Output("speeds.dat", "profile", ("Coord1", *_each(kinds, "labels", "chances"))),
    )


def _each(kinds: int, *names: str) -> tuple[str, ...]:
    return tuple(f"{name}_{number}" for number in range(1, kinds + 1) for name in names)
