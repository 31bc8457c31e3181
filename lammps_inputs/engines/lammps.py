"""Lines that the decks of several engines have."""

from collections.abc import Iterable, Iterator, Sequence

from lammps_inputs.engines.engine import Start
from lammps_inputs.initial_state import InitialState
from lammps_inputs.system import Interaction, Output, System, WallPotential

FACES = {"lower": "lo", "upper": "hi"}


def read(start: Start) -> Iterator[str]:
    """The state the deck starts from."""
    yield f"read_restart {start.checkpoint}" if start.checkpoint else "read_data state.data"


def particle_group(system: System) -> str:
    """The LAMMPS group of all species together."""
    return system.species[0].name if len(system.species) == 1 else "particles"


def groups(system: System) -> Iterator[str]:
    """A group for each species, and one of all where there are several."""
    types = system.types()
    for name, number in types.items():
        yield f"group {name} type {number}"
    if len(types) > 1:
        yield f"group {particle_group(system)} type {' '.join(map(str, types.values()))}"


def pairs(system: System, overlay: str = "", seed: str = "${seed}") -> Iterator[str]:
    """The pair style of the species, which `one_pair_style` has checked; another laid over it.

    `seed` is the variable of the deck for a style that draws random numbers.
    """
    types = system.types()
    between = system.particle_interactions()
    for interaction in between:
        yield f"# {interaction.potential.title} {_between(interaction)}"
    first = between[0].potential
    cutoff = max(interaction.potential.cutoff for interaction in between)
    style = f"{first.pair_style}{first.pair_arguments(cutoff, seed)}"
    yield f"pair_style hybrid/overlay {style} {overlay}" if overlay else f"pair_style {style}"
    named = f" {first.pair_style}" if overlay else ""
    missing = {(a, b) for a in types.values() for b in types.values() if a <= b}
    for interaction in between:
        low, high = sorted((types[interaction.first], types[interaction.second]))
        missing.discard((low, high))
        yield interaction.potential.pair_coeff(f"{low} {high}{named}")
    for low, high in sorted(missing):
        yield first.no_pair_coeff(f"{low} {high}{named}")


def _between(interaction: Interaction) -> str:
    if interaction.first == interaction.second:
        return f"of the {interaction.first}"
    return f"of {interaction.first} and {interaction.second}"


def one_pair_style(system: System) -> Iterator[str]:
    """A line where the species' interactions need more than one LAMMPS pair style."""
    styles = {i.potential.pair_style for i in system.particle_interactions()}
    if len(styles) > 1:
        yield f"interactions of styles {', '.join(sorted(styles))}: only one of them is possible"


def wall_faces(system: System) -> list[tuple[str, str, WallPotential, list[str]]]:
    """Fix name, species, potential and faces (`ylo`) of what repels a species."""
    found: dict[tuple[str, WallPotential], list[str]] = {}
    for wall in system.walls:
        for species, potential in wall.potentials:
            found.setdefault((species, potential), []).append("xyz"[wall.axis] + FACES[wall.side])
    names = ["wall", *(f"wall{number}" for number in range(2, len(found) + 1))]
    return [
        (name, species, potential, faces)
        for name, ((species, potential), faces) in zip(names, found.items(), strict=False)
    ]


def drives(system: System) -> Iterator[str]:
    """The drives on species."""
    for variable, together in system.drive_variables().items():
        on_species = [drive for drive in together if drive.target in system.types()]
        for drive in on_species:
            name = variable if len(on_species) == 1 else f"{variable}_{drive.target}"
            direction = " ".join(f"{component:.17g}" for component in drive.direction)
            yield f"fix {name} {drive.target} gravity ${{{variable}}} vector {direction}"


def rotational_temperature(system: System) -> Iterator[str]:
    """The variable of that name, in 3D: a third of twice the energy of rotation of each."""
    yield f"compute rotation {particle_group(system)} erotate/sphere"
    rotating = sum(species.count for species in system.species if species.inertia)
    yield f"variable rotational_temperature equal 2*c_rotation/{3 * rotating}"


def window(system: System) -> str:
    """Nevery, Nrepeat and Nfreq of an average over each sampling interval."""
    look = system.clock.look_steps
    return f"{look} $(v_sample/{look}:%.0f) ${{sample}}"


def table(output: Output, system: System, start: Start) -> Iterator[str]:
    """The averages of each sampling interval, from variables of the columns' names, and the log."""
    columns = " ".join(f"v_{column}" for column in output.columns)
    file = "append" if start.checkpoint else "file"
    yield f"fix observables all ave/time {window(system)} {columns} {file} {output.file}"
    yield "thermo $(20*v_sample)"
    yield f"thermo_style custom step {columns}"


def trajectory(output: Output, system: System, start: Start) -> Iterator[str]:
    """The particles, at every sampled step."""
    yield (
        f"dump trajectory {particle_group(system)} custom ${{sample}} {output.file} "
        + " ".join(output.columns)
    )
    append = " append yes" if start.checkpoint else ""
    yield f"dump_modify trajectory sort id first yes format float %.10g{append}"


def data_header(
    system: System, title: str, atoms: int, types: int, tilt: float = 0.0
) -> Iterator[str]:
    """The head of a data file: what it is, counts, the box."""
    yield f"# narrows: {title}\n\n"
    yield f"{atoms} atoms\n{types} atom types\n\n"
    sizes = (*system.box.sizes, 0.0)[:3]
    for axis, (name, size) in enumerate(zip("xyz", sizes, strict=True)):
        low, high = (0.0, size) if axis < system.box.dimensions else (-0.5, 0.5)
        yield f"{low!r} {high!r} {name}lo {name}hi\n"
    if system.shear_rate:
        yield f"{tilt!r} 0.0 0.0 xy xz yz\n"


def particle_data(system: System, state: InitialState, title: str) -> Iterable[str]:
    """The data file of the species alone, of atom style sphere where they rotate, else atomic."""
    types = max(1, len(system.species))  # LAMMPS needs a type, also of no atoms
    yield from data_header(system, title, system.particles, types, state.tilt)
    masses = [species.mass for species in system.species] or [1.0]
    if system.rotates:
        yield from _sphere_data(system, state)
        return
    yield "\nMasses\n\n"
    yield from (f"{number} {mass!r}\n" for number, mass in enumerate(masses, start=1))
    if not system.particles:
        return
    kinds = system.atom_types()
    yield "\nAtoms # atomic\n\n"
    for i, (kind, row) in enumerate(zip(kinds, state.colloid_positions, strict=True), start=1):
        yield f"{i} {kind} {coordinates(row.tolist())}\n"
    yield "\nVelocities\n\n"
    for i, row in enumerate(state.colloid_velocities, start=1):
        yield f"{i} {coordinates(row.tolist())}\n"


def _sphere_data(system: System, state: InitialState) -> Iterable[str]:
    """Of density 1: the deck sets the masses."""
    kinds, sizes = system.atom_types(), (2 * system.radii).tolist()
    yield "\nAtoms # sphere\n\n"
    rows = zip(kinds, sizes, state.colloid_positions.tolist(), strict=True)
    for i, (kind, size, row) in enumerate(rows, start=1):
        yield f"{i} {kind} {size!r} 1.0 {coordinates(row)}\n"
    yield "\nVelocities\n\n"
    moves = zip(state.colloid_velocities.tolist(), state.colloid_spins.tolist(), strict=True)
    for i, (row, spin) in enumerate(moves, start=1):
        yield f"{i} {coordinates(row)} {coordinates(spin)}\n"


def coordinates(row: Sequence[float]) -> str:
    """Three components, zero where space has only two."""
    return " ".join(repr(component) for component in (*row, 0.0)[:3])
