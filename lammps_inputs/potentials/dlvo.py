"""The interaction of charged colloids (hecht-2005, section II): numpy beside `pair_style dlvo`.

Screened Coulomb repulsion (1) and van der Waals attraction (2) of equal spheres; Hertz's contact
(3); a parabola in place of the primary minimum, where (2) diverges; damping (6 corrected),
transverse friction, lubrication (4), and the fluctuations that the three demand. Distances in a0,
energies in kBT, masses in m_f.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class Dlvo:
    """Interaction of two equal spheres.

    Attributes:
        diameter: d [a0].
        coulomb: prefactor of (1), pi eps_r eps_0 [4 kBT/(z e) tanh(z e Psi_0 / 4 kBT)]^2 [kBT/a0].
        kappa: inverse screening length [1/a0].
        hamaker: A_H of (2) [kBT].
        hertz: K of (3) [kBT/a0^(5/2)].
        depth: of the parabola [kBT]; needed where A_H is positive.
        damping: beta of (6) [m_f/(t0 a0^(1/2))].
        friction: of the surfaces in contact, transverse [m_f/t0].
        viscosity: eta of (4) [m_f/(a0 t0)]; 0: no lubrication.
        closest, farthest: gaps at which lubrication is largest, and from which it is zero [a0].
        error: energy that is neglected beyond the cutoff [kBT].
    """

    diameter: float
    coulomb: float = 0.0
    kappa: float = 1.0
    hamaker: float = 0.0
    hertz: float = 0.0
    depth: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    viscosity: float = 0.0
    closest: float = 0.01
    farthest: float = 1.0
    error: float = 0.02

    def __post_init__(self) -> None:
        if self.hamaker > 0 and not self.depth > 0:
            raise ValueError(f"depth {self.depth}: must be positive, (2) diverges at contact")

    def coulomb_energy(self, r: ArrayLike) -> Array:
        """Screened Coulomb repulsion (1) [kBT]."""
        r = np.asarray(r, dtype=float)
        return np.asarray(
            self.coulomb * self.diameter**2 / r * np.exp(-self.kappa * (r - self.diameter))
        )

    def van_der_waals_energy(self, r: ArrayLike) -> Array:
        """Attraction of two spheres (2), r > d [kBT]."""
        ratio = (self.diameter / np.asarray(r, dtype=float)) ** 2
        sum_ = ratio / (1 - ratio) + ratio + 2 * np.log1p(-ratio)
        return np.asarray(-self.hamaker / 12 * sum_)

    def dlvo_energy(self, r: ArrayLike) -> Array:
        """(1) and (2) without what replaces them near contact [kBT]."""
        energy = self.coulomb_energy(r)
        return energy + self.van_der_waals_energy(r) if self.hamaker else energy

    def dlvo_force(self, r: ArrayLike) -> Array:
        """-dV/dr of `dlvo_energy` [kBT/a0]."""
        r = np.asarray(r, dtype=float)
        force = self.coulomb_energy(r) * (1 / r + self.kappa)
        if self.hamaker:
            gap = r**2 - self.diameter**2
            force = force - self.hamaker / 6 * self.diameter**6 / (r**3 * gap**2)
        return force

    @cached_property
    def joint(self) -> float:
        """Distance r_j up to which the parabola stands for (1) and (2) [a0].

        -depth + k (r - d)^2 / 2 has the energy and the force of V at r_j where
        V + depth = (r_j - d) V' / 2: the innermost such place, inside the barrier if there is any.
        """
        if not self.hamaker:
            return self.diameter

        def excess(gap: float) -> float:
            r = self.diameter + gap
            return float(self.dlvo_energy(r) + self.depth + 0.5 * gap * self.dlvo_force(r))

        inner = outer = 1e-8 * self.diameter
        while excess(outer) < 0:
            inner, outer = outer, 1.01 * outer
        for _ in range(200):
            middle = 0.5 * (inner + outer)
            if excess(middle) < 0:
                inner = middle
            else:
                outer = middle
        return self.diameter + outer

    @property
    def stiffness(self) -> float:
        """k of the parabola [kBT/a0^2]."""
        return float(-self.dlvo_force(self.joint) / (self.joint - self.diameter))

    def energy(self, r: ArrayLike) -> Array:
        """Energy at distances r > 0 (any shape) [kBT]."""
        r = np.asarray(r, dtype=float)
        overlap = np.maximum(self.diameter - r, 0.0)
        outside = np.maximum(r, self.joint) if self.hamaker else r
        energy = self.dlvo_energy(outside)
        if self.hamaker:
            gap = np.maximum(r - self.diameter, 0.0)
            energy = np.where(r < self.joint, -self.depth + 0.5 * self.stiffness * gap**2, energy)
        return np.asarray(energy + self.hertz * overlap**2.5)

    def force(self, r: ArrayLike) -> Array:
        """Radial force -dU/dr, positive when repulsive, at distances r > 0 [kBT/a0]."""
        r = np.asarray(r, dtype=float)
        overlap = np.maximum(self.diameter - r, 0.0)
        outside = np.maximum(r, self.joint) if self.hamaker else r
        force = self.dlvo_force(outside)
        if self.hamaker:
            gap = np.maximum(r - self.diameter, 0.0)
            force = np.where(r < self.joint, -self.stiffness * gap, force)
        return np.asarray(force + 2.5 * self.hertz * overlap**1.5)

    def normal_friction(self, r: ArrayLike) -> Array:
        """Force against a relative velocity along the line of centres, over that velocity [m_f/t0].

        Lubrication, 6 pi eta r_red^2 / (r - d + closest) as (4) shifted to smaller distances, so
        that it is largest in contact; less its value at the farthest gap, from which on it is zero:
        the fluid itself has what is beyond. In contact beta sqrt(d - r) is added (6 corrected).
        """
        gap = np.asarray(r, dtype=float) - self.diameter
        reduced = self.diameter / 4  # (5) of equal spheres
        lubrication = 1 / (np.maximum(gap, 0.0) + self.closest) - 1 / (self.farthest + self.closest)
        friction = 6 * math.pi * self.viscosity * reduced**2 * np.maximum(lubrication, 0.0)
        return np.asarray(friction + self.damping * np.sqrt(np.maximum(-gap, 0.0)))

    @cached_property
    def cutoff(self) -> float:
        """Distance from which |V| stays below `error`; beyond contact and minimum [a0].

        Nothing of the secondary minimum lies beyond: V is bounded there by the sum of (1) and the
        magnitude of (2), both of which fall with the distance.
        """

        def bound(r: float) -> float:
            bound = float(self.coulomb_energy(r))
            return bound - float(self.van_der_waals_energy(r)) if self.hamaker else bound

        inner = max(self.joint, self.diameter * (1 + 1e-9))
        outer = inner
        while bound(outer) > self.error:
            inner, outer = outer, 1.1 * outer
        for _ in range(100):
            middle = 0.5 * (inner + outer)
            if bound(middle) > self.error:
                inner = middle
            else:
                outer = middle
        return max(outer, self.diameter * 1.001)

    @cached_property
    def reach(self) -> float:
        """Distance from which on there is neither force nor friction [a0]."""
        return max(self.cutoff, self.diameter + self.farthest if self.viscosity else 0.0)

    @cached_property
    def barrier(self) -> float:
        """Highest energy on the way from far to the parabola [kBT]."""
        r = np.geomspace(1e-6 * self.diameter, self.cutoff - self.diameter, 4000) + self.diameter
        return float(self.energy(r[r >= self.joint]).max())

    def stiffest(self, energy: float) -> float:
        """Largest |d^2 U/dr^2| at distances reached from far with so much energy [kBT/a0^2].

        Overlaps up to a tenth of the radius count where contact is reached.
        """
        gaps = np.geomspace(1e-6 * self.diameter, self.cutoff - self.diameter, 4000)
        overlaps = np.linspace(-0.05 * self.diameter, 0.0, 200)
        r = self.diameter + np.concatenate([overlaps, gaps])
        high = np.flatnonzero(self.energy(r) > energy)
        r = r[high[-1] :] if len(high) else r
        if len(r) < 3:
            r = np.linspace(r[0], r[0] + 1e-3 * self.diameter, 10)
        return float(np.abs(np.diff(self.force(r)) / np.diff(r)).max())

    @property
    def title(self) -> str:
        """`DLVO interaction`."""
        return "DLVO interaction, contact and lubrication"

    @property
    def pair_style(self) -> str:
        """The LAMMPS style."""
        return "dlvo"

    def pair_arguments(self, cutoff: float, seed: str) -> str:
        """The cutoff, the temperature of the fluctuations, that of the fluid, and their seed."""
        return f" {cutoff!r} 1.0 {seed}"

    @property
    def pair_modify(self) -> str:
        """Arguments of `pair_modify`."""
        return "shift yes"

    @property
    def dissipates(self) -> bool:
        """Whether there is any friction."""
        return self.damping > 0 or self.friction > 0 or self.viscosity > 0

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""
        return f"pair_coeff {types} {self.diameter!r}"

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line for the two atom types."""
        terms = [f"pair_coeff {types} {self.diameter!r}"]
        if self.coulomb:
            terms.append(f"coulomb {self.coulomb!r} {self.kappa!r}")
        if self.hamaker:
            terms.append(f"vdw {self.hamaker!r} minimum {self.depth!r}")
        for name in ("hertz", "damping", "friction"):
            if getattr(self, name):
                terms.append(f"{name} {getattr(self, name)!r}")
        if self.viscosity:
            terms.append(f"lubrication {self.viscosity!r} {self.closest!r} {self.farthest!r}")
        return " ".join(terms)
