"""From a suspension in the laboratory to a simulation, and back (hecht-2005, sections VI and VII).

A simulation keeps the Peclet number, the settling and the diffusion time, and the ratio of every
energy to kBT. It changes the viscosity, and with it the Reynolds number and the times of
relaxation: they come closer to each other, which is what makes it affordable, but must stay in
order. Units are SI; reduced units are a = kBT = m_f = 1, of time t0 = a sqrt(m_f / kBT).
"""

import math
from dataclasses import dataclass, fields

from lammps_inputs.potentials.dlvo import Dlvo

BOLTZMANN = 1.38e-23  # as the paper has it [J/K]
ELEMENTARY_CHARGE = 1.602176634e-19  # [C]
VACUUM_PERMITTIVITY = 8.8541878128e-12  # [F/m]
WATER = 81.0  # eps_r that gives minima of the kind of Fig. 1


@dataclass(frozen=True)
class Suspension:
    """Spheres in a liquid; the defaults are Table I, alumina in water.

    Attributes:
        radius: R [m].
        temperature: T [K].
        particle_density: rho_m [kg/m^3].
        fluid_density: rho_w [kg/m^3].
        viscosity: kinematic, nu [m^2/s].
        gravity: g [m/s^2].
        hamaker: A_H [J].
        minimum: distance l of the primary minimum from the surface [m].
    """

    radius: float = 0.4e-6
    temperature: float = 300.0
    particle_density: float = 3.9e3
    fluid_density: float = 1e3
    viscosity: float = 1e-6
    gravity: float = 9.81
    hamaker: float = 4.76e-20
    minimum: float = 8e-9

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not (
                math.isfinite(value) and (value > 0 or (field.name == "gravity" and value == 0))
            ):
                raise ValueError(f"{field.name} {value}: must be positive")

    @property
    def thermal_energy(self) -> float:
        """kBT [J]."""
        return BOLTZMANN * self.temperature

    @property
    def mass(self) -> float:
        """Of a particle [kg]."""
        return 4 / 3 * math.pi * self.radius**3 * self.particle_density

    @property
    def stokes_velocity(self) -> float:
        """v_S (16) [m/s]."""
        excess = self.particle_density / self.fluid_density - 1
        return 2 / 9 * self.radius**2 * self.gravity / self.viscosity * excess

    @property
    def diffusion_coefficient(self) -> float:
        """D (18) [m^2/s]."""
        friction = 6 * math.pi * self.viscosity * self.fluid_density * self.radius
        return self.thermal_energy / friction

    def time_scales(self) -> "TimeScales":
        """All of section VI (Table II)."""
        settling = 2 * self.radius / self.stokes_velocity if self.stokes_velocity else math.inf
        diffusion = 2 * self.radius**2 / self.diffusion_coefficient
        return TimeScales(
            settling=settling,
            diffusion=diffusion,
            gap=diffusion / 16,
            interaction=2 * math.pi * math.sqrt(self.mass * self.minimum**2 / self.hamaker),
            fluid=2 * self.radius**2 / self.viscosity,
            particle=2
            * self.radius**2
            * self.particle_density
            / (9 * self.viscosity * self.fluid_density),
        )


@dataclass(frozen=True)
class TimeScales:
    """The times of a suspension [s].

    Attributes:
        settling: tau_S, to settle by a diameter (17); infinite without gravity.
        diffusion: tau_D, to diffuse by a diameter (20).
        gap: tau_G, to diffuse across a gap of R / 2, tau_D / 16.
        interaction: tau_V, period of an oscillation in the primary minimum (26).
        fluid: tau_F, for momentum to diffuse by a diameter (24).
        particle: tau_P, for a velocity to relax (23).
    """

    settling: float
    diffusion: float
    gap: float
    interaction: float
    fluid: float
    particle: float

    @property
    def peclet(self) -> float:
        """Pe = tau_D / tau_S (21)."""
        return self.diffusion / self.settling

    @property
    def reynolds(self) -> float:
        """Re = tau_F / tau_S (25)."""
        return self.fluid / self.settling

    @property
    def creeping(self) -> bool:
        """Whether oscillations in the minimum are overdamped without lubrication (27)."""
        return self.particle <= self.interaction / (4 * math.pi)

    def lost_order(self) -> list[str]:
        """What is not as it must be: particles relax before they meet, momentum diffuses faster
        than particles, which meet before they have diffused far."""
        order = [
            ("particle", "gap", "particles do not relax before they meet"),
            ("fluid", "gap", "momentum in the fluid is no faster than the particles"),
            ("particle", "fluid", "particles relax more slowly than the fluid around them"),
        ]
        return [
            f"{first} {getattr(self, first):.3g} s, {second} {getattr(self, second):.3g} s: {why}"
            for first, second, why in order
            if not getattr(self, first) < getattr(self, second)
        ]


@dataclass(frozen=True)
class Model:
    """A simulation of a suspension by MPC with rotations by 90 degrees (section VII).

    Attributes:
        suspension: what is simulated.
        cell: edge of a collision cell a [m].
        density: fluid particles in a cell M.
        mean_free_path: lambda over a.
    """

    suspension: Suspension
    cell: float
    density: float
    mean_free_path: float

    def __post_init__(self) -> None:
        for name in ("cell", "density", "mean_free_path"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > (1 if name == "density" else 0)):
                least = "more than 1" if name == "density" else "positive"
                raise ValueError(f"{name} {value}: must be {least}")

    @classmethod
    def reflecting(cls, suspension: Suspension) -> "Model":
        """Coupling I as in VII B: a = R / 2, M = 2.5, lambda = 0.6 a."""
        return cls(suspension, suspension.radius / 2, 2.5, 0.6)

    @classmethod
    def in_collision(cls, suspension: Suspension, cell: float | None = None) -> "Model":
        """Coupling II as in VII C: a cell of the volume of a particle, M = 60, lambda = 0.5 a.

        The volumes agree at a = (4 pi / 3)^(1/3) R = 6.45e-7 m; the numbers of the paper follow
        from its 6.25e-7 m.
        """
        edge = cell or (4 / 3 * math.pi) ** (1 / 3) * suspension.radius
        return cls(suspension, edge, 60.0, 0.5)

    @property
    def viscosity_factor(self) -> float:
        """nu dt / a^2 of (28), (29): for exactly M particles in every cell.

        `lammps_inputs.viscosity` has it for the Poisson distribution of the real fluid, 6 % more at
        M = 2.5.
        """
        collisions = (1 - (1 - math.exp(-self.density)) / self.density) / 18
        flight = self.mean_free_path**2 * (self.density + 2) / (4 * (self.density - 1))
        return collisions + flight

    @property
    def collision_time(self) -> float:
        """dt, such that the model diffuses as the suspension does (30) [s]."""
        s = self.suspension
        return (
            self.mean_free_path**2
            * self.cell**3
            / (6 * math.pi * self.viscosity_factor * self.density)
            / (s.diffusion_coefficient * s.radius)
        )

    @property
    def viscosity(self) -> float:
        """nu of the model (29) [m^2/s]."""
        return self.viscosity_factor * self.cell**2 / self.collision_time

    @property
    def gravity(self) -> float:
        """g of the model, on particles alone: buoyancy is in it (31) [m/s^2]."""
        s = self.suspension
        lighter = 1 - s.fluid_density / s.particle_density
        return s.gravity * self.viscosity / s.viscosity * lighter

    @property
    def fluid_mass(self) -> float:
        """m_f, from M m_f / a^3 = rho_w [kg]."""
        return self.suspension.fluid_density * self.cell**3 / self.density

    @property
    def thermal_energy(self) -> float:
        """kBT of the model, m_f lambda^2 / dt^2 [J]."""
        return self.fluid_mass * (self.mean_free_path * self.cell / self.collision_time) ** 2

    @property
    def temperature(self) -> float:
        """T of the model [K]."""
        return self.thermal_energy / BOLTZMANN

    @property
    def energy_scale(self) -> float:
        """By how much kBT and all other energies are smaller than in the suspension."""
        return self.suspension.thermal_energy / self.thermal_energy

    def time_scales(self) -> TimeScales:
        """Tables III and IV: settling and diffusion are those of the suspension."""
        s, real = self.suspension, self.suspension.time_scales()
        return TimeScales(
            real.settling,
            real.diffusion,
            real.gap,
            interaction=real.interaction * math.sqrt(self.energy_scale),
            fluid=2 * s.radius**2 / self.viscosity,
            particle=2 * s.radius**2 * s.particle_density / (9 * self.viscosity * s.fluid_density),
        )

    @property
    def time_unit(self) -> float:
        """t0 = a sqrt(m_f / kBT) = dt a / lambda [s]."""
        return self.collision_time / self.mean_free_path

    @property
    def reduced_radius(self) -> float:
        """R [a]."""
        return self.suspension.radius / self.cell

    @property
    def reduced_mass(self) -> float:
        """Of a particle [m_f]."""
        return self.suspension.mass / self.fluid_mass

    @property
    def reduced_gravity(self) -> float:
        """g of the model [a/t0^2]."""
        return self.gravity * self.time_unit**2 / self.cell

    @property
    def reduced_viscosity(self) -> float:
        """eta = nu rho of the model, for lubrication [m_f/(a t0)]."""
        return self.viscosity_factor / self.mean_free_path * self.density

    @property
    def schmidt(self) -> float:
        """nu over the self-diffusion coefficient of the fluid.

        The latter is kBT dt / m_f [3 M / (2 (M - 1 + e^-M)) - 1 / 2] for rotations by 90 degrees in
        three dimensions (Kikuchi, Pooley, Ryder and Yeomans, J. Chem. Phys. 119, 6388, 2003).
        """
        colliding = (self.density - 1 + math.exp(-self.density)) / self.density
        return self.viscosity_factor / (self.mean_free_path**2 * (1.5 / colliding - 0.5))

    @property
    def mach(self) -> float:
        """Stokes velocity over the speed of sound sqrt(5 kBT / (3 m_f))."""
        sound = math.sqrt(5 / 3 * self.thermal_energy / self.fluid_mass)
        return self.suspension.stokes_velocity / sound

    @property
    def knudsen(self) -> float:
        """lambda / R."""
        return self.mean_free_path / self.reduced_radius

    def interaction(
        self,
        surface_potential: float,
        kappa: float,
        hertz: float,
        depth: float,
        valency: int = 1,
        permittivity: float = WATER,
        lubrication: tuple[float, float] | None = None,
    ) -> Dlvo:
        """The potential of the suspension in reduced units; energies over kBT are the real ones.

        Args:
            surface_potential: Psi_0 [V].
            kappa: inverse screening length [1/m].
            hertz: K [kBT/a^(5/2)].
            depth: of the primary minimum [kBT].
            valency: z of the ions.
            permittivity: eps_r of the liquid.
            lubrication: closest and farthest gap [a]; None: no lubrication.
        """
        s = self.suspension
        closest, farthest = lubrication or (0.01, 1.0)
        return Dlvo(
            diameter=2 * self.reduced_radius,
            coulomb=coulomb_strength(surface_potential, s.temperature, valency, permittivity)
            * self.cell
            / s.thermal_energy,
            kappa=kappa * self.cell,
            hamaker=s.hamaker / s.thermal_energy,
            hertz=hertz,
            depth=depth,
            viscosity=self.reduced_viscosity if lubrication else 0.0,
            closest=closest,
            farthest=farthest,
        )


def coulomb_strength(
    surface_potential: float, temperature: float, valency: int = 1, permittivity: float = WATER
) -> float:
    """pi eps_r eps_0 [4 kBT/(z e) tanh(z e Psi_0/(4 kBT))]^2, the prefactor of (1) [J/m]."""
    volts = 4 * BOLTZMANN * temperature / (valency * ELEMENTARY_CHARGE)
    screened = volts * math.tanh(surface_potential / volts)
    return math.pi * permittivity * VACUUM_PERMITTIVITY * screened**2
