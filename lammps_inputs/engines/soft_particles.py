"""The deck lines of particles under thermostats, with or without shear (delhommelle-2005)."""

from collections.abc import Iterator

from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from lammps_inputs.system import Configurational, DissipativePairs, Isokinetic, Langevin, System

POTENTIALS = (SoftDisk, WeeksChandlerAndersen)  # with three derivatives; of our plugin
MOTIONS = (Isokinetic, Configurational, Langevin, DissipativePairs)
PUT_BACK = (
    "set group all x v_place_x y v_place_y z v_place_z image v_place_ix v_place_iy v_place_iz"
)
# LAMMPS keeps no noise in restart files: each sampling interval has a seed of its own, by its step.
# Seeds end at 900000000; the prime keeps the intervals of runs with neighbouring seeds apart.
NOISE_SEED = "$((v_seed+7919*step-1)%900000000+1:%.0f)"


def needs_plugin(system: System) -> bool:
    """Whether a style of ours stands for a part."""
    compiled = any(isinstance(i.potential, POTENTIALS) for i in system.interactions)
    return compiled or bool(system.rest) or isinstance(system.motion, Isokinetic | Configurational)


def problems(system: System) -> Iterator[str]:
    """What keeps the thermostats from running."""
    if isinstance(system.motion, Configurational):
        for i in system.interactions:
            if not isinstance(i.potential, POTENTIALS):
                yield (
                    f"{i.potential!r} between {i.first} and {i.second}: the configurational "
                    "temperature needs three derivatives, of soft/disk or wca"
                )
    if system.shear_rate and not all(system.box.periodic):
        yield f"shear_rate = {system.shear_rate!r}: needs a box that is periodic in all directions"


def dissipative_style(system: System) -> str:
    """The pair style of dissipative particle dynamics, which lies over the potential's."""
    motion = system.motion
    if not isinstance(motion, DissipativePairs):
        return ""
    return f"dpd/tstat {motion.temperature!r} {motion.temperature!r} {motion.cutoff!r} {NOISE_SEED}"


def dissipative_pairs(system: System) -> Iterator[str]:
    """What else that style needs."""
    if isinstance(system.motion, DissipativePairs):
        yield f"pair_coeff * * dpd/tstat {system.motion.friction!r}"
        yield "comm_modify vel yes # the friction of a pair is by both velocities"


def preparation(system: System) -> Iterator[str]:
    """The rest before the run, and then the flow of a shear."""
    if system.rest:
        yield "# at rest before step 0, the kinetic energy constant"
        yield f"fix rest all isokinetic {system.rest.temperature!r}"
        yield f"run {system.rest.steps} post no"
        yield "unfix rest"
        yield "reset_timestep 0"
    if system.shear_rate:
        yield f"variable shear equal {system.shear_rate!r}*ly"
        yield "velocity all ramp vx 0 ${shear} y $(ylo) $(yhi) sum yes units box"


def kept_places() -> Iterator[str]:
    """Places of a sheared box to the last bit, for the command `PUT_BACK`."""
    yield "# restart files round places in a tilted box: they are kept, and put back at each output"
    yield "fix places all store/state 1 x y z ix iy iz"
    for number, name in enumerate(("x", "y", "z", "ix", "iy", "iz"), start=1):
        yield f"variable place_{name} atom f_places[{number}]"


def motion(system: System) -> Iterator[str]:
    """What moves the particles."""
    motion = system.motion
    if system.shear_rate:
        yield f"fix shear all deform 1 xy erate {system.shear_rate!r} remap v units box"
    sllod = "/sllod" if system.shear_rate else ""
    match motion:
        case Isokinetic():
            directions = "" if sllod else f" {motion.directions}"
            yield f"fix motion all isokinetic{sllod} {motion.temperature!r}{directions}"
        case Configurational():
            constants = f"{motion.temperature!r} {motion.damping!r}"
            yield f"fix motion all configurational{sllod} {constants}"
        case Langevin():
            yield "fix motion all nve"
            yield langevin_noise(motion)
        case _:
            yield "fix motion all nve"


def langevin_noise(motion: Langevin) -> str:
    """The noise and friction of a sampling interval."""
    temperature = f"{motion.temperature!r} {motion.temperature!r}"
    return f"fix noise all langevin {temperature} {1 / motion.friction!r} {NOISE_SEED}"


def computes(system: System) -> Iterator[str]:
    """What the columns of `expressions` are computed by."""
    columns = {name for output in system.outputs for name in output.columns}
    if "pressure" in columns:
        yield "compute virial all pressure NULL virial"
    if system.shear_rate:
        yield "compute relative all temp/deform"
        yield "compute stress all pressure relative"
    if "laplacians" in columns and not isinstance(system.motion, Configurational):
        yield "compute configurations all temp/configurational"


def expressions(system: System) -> dict[str, str]:
    """LAMMPS's expression of each column that a table may have."""
    temperature = "c_relative" if system.shear_rate else "c_thermo_temp"
    known = {
        "kinetic_temperature": f"{temperature}*(atoms-1)/atoms",
        "potential_energy": "c_thermo_pe/atoms",
        "pressure": "c_virial",
        "force_squares": "c_configurations[1]",
        "laplacians": "c_configurations[2]",
    }
    shares = [
        f"{drive.direction[0] * species.count / system.particles:+.17g}*vcm({species.name},x)"
        for species in system.species
        for drive in system.drives_on(species.name)
    ]
    if shares:
        known["current"] = "".join(shares).removeprefix("+")
    if system.shear_rate:
        known["pressure_xy"] = "c_stress[4]"
    if isinstance(system.motion, Isokinetic):
        known["thermostat_friction"] = "f_motion"
    if isinstance(system.motion, Configurational):
        known |= {"force_squares": "f_motion[2]", "laplacians": "f_motion[3]"}
        known["thermostat_multiplier"] = "f_motion[1]"
    return known
