"""Colloids as hard, rotating spheres that reflect the fluid with thermal velocities (hecht-2005,
IV).

Disks in two dimensions. Arrays hold the components first: fluid (d, N), colloids (d, N_c), spins as
in `rotation`.

Either a particle that has ended inside a colloid is put at the `nearest` point of the surface,
half a step ago. Or a particle that has met a colloid on its way is put at the point of `entry`,
when it met it: also if it has ended outside, as those who graze a colloid do. It leaves with a
velocity of (13) and (14) in the frame of the surface, flies for the rest of the time, and is
looked at again, up to N_max contacts.

The surface has the velocity V + share (V' - V), V' being that of the colloid after the contacts of
the interval: see `surfaces`.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.boundaries import Boundaries, stream
from srd_driver.reference.counter_random import CounterRandom, Stream
from srd_driver.reference.rotation import cross, torque

Indices = NDArray[np.intp]
Placement = Literal["entry", "nearest"]

MOST_CONTACTS = 10  # N_max
SHARES = {2: (3 / 2 + math.pi / 4) / 2, 3: (4 / 3 + math.pi / 6) / 2}


@dataclass(frozen=True)
class Spheres:
    """The colloids at the end of an interval.

    Attributes:
        positions, velocities: (d, N_c).
        spins: (3, N_c) or (1, N_c).
        radii, masses, inertias: (N_c,).
        mean_velocities: over the interval (d, N_c); default: the velocities.
    """

    positions: Array
    velocities: Array
    spins: Array
    radii: Array
    masses: Array
    inertias: Array
    mean_velocities: Array | None = None

    @property
    def ways(self) -> Array:
        """Velocities on a straight way through the interval (d, N_c)."""
        return self.velocities if self.mean_velocities is None else self.mean_velocities


@dataclass(frozen=True)
class Contacts:
    """Fluid particles that have met colloids, and how.

    Attributes:
        particles, colloids: their numbers (n,).
        arms: from the centre of the colloid to the contact (d, n).
        velocities: with which they came (d, n).
        left: time from the contact to the end of the interval (n,).
    """

    particles: Indices
    colloids: Indices
    arms: Array
    velocities: Array
    left: Array


def find_contacts(
    positions: Array,
    velocities: Array,
    flown: Array,
    spheres: Spheres,
    placement: Placement,
    interval: float,
    field: Array,
    boundaries: Boundaries,
) -> Contacts:
    """The first contact of each particle on its way; `nearest`: with the colloid it is deepest in.

    The way is straight in the frame of the colloid. A particle that has been inside for all of its
    flight is put at the nearest point, half of its flight ago.

    Args:
        positions, velocities: of the fluid (d, N).
        flown: how long each has flown, since the last contact or for the interval (N,).
        spheres: the colloids.
        placement: where a particle is put.
        interval: between collisions.
        field: acceleration of the fluid (d, 1).
        boundaries: the box.
    """
    separation = positions[:, :, None] - spheres.positions[:, None, :]
    for axis, size in enumerate(boundaries.box):
        if boundaries.periodic[axis]:
            separation[axis] -= size * np.rint(separation[axis] / size)
    inside = 1 - (separation**2).sum(axis=0) / spheres.radii**2
    mean = (velocities - 0.5 * flown * field)[:, :, None] - spheres.ways[:, None, :]
    ago = inside
    if placement == "entry":
        approach, speed = (mean * separation).sum(axis=0), (mean**2).sum(axis=0)
        root = approach**2 + speed * inside * spheres.radii**2
        ago = (approach + np.sqrt(np.maximum(root, 0.0))) / np.where(speed > 0, speed, 1.0)
        ago[(root <= 0) | (ago < 0)] = -1.0
        late = ago > flown[:, None] * (1 + 1e-9)
        ago = np.where(late, np.where(inside > 0, np.inf, -1.0), np.minimum(ago, flown[:, None]))
    colloids = ago.argmax(axis=1)
    particles = np.flatnonzero(ago.max(axis=1) > (-1 if placement == "entry" else 0))
    colloids = colloids[particles]
    at = (slice(None), particles, colloids)
    inside, mean, left = separation[at], mean[at], ago[particles, colloids]
    radius, came = spheres.radii[colloids], velocities[:, particles].copy()
    if placement == "entry":
        entered = np.isfinite(left)
        left[~entered] = 0.5 * flown[particles[~entered]]
        inside -= np.where(entered, left, 0.0) * mean
    else:
        left = np.full(left.shape, 0.5 * interval)
    came -= left * field
    arms = inside * (radius / np.sqrt((inside**2).sum(axis=0)))
    return Contacts(particles, colloids, arms, came, left)


def thermal_velocities(
    contacts: Contacts, temperature: float, contact: int, random: CounterRandom, particles: int
) -> Array:
    """Velocities that leave a surface at rest (d, n): (13) along the normal, (14) along tangents.

    From the particle's block number `contact` of stream REFLECTION: the normal component is
    sqrt(-2 kBT ln(1 - u0)), the tangential ones sqrt(kBT) times the normals from u2 and u3. The
    first tangent lies beside the axis along which the normal is least (the first of several).
    """
    u = random.uniform(Stream.REFLECTION, particles, contact)[:, contacts.particles]
    normal = contacts.arms / np.sqrt((contacts.arms**2).sum(axis=0))
    thermal = math.sqrt(temperature)
    along = thermal * np.sqrt(-2 * np.log1p(-u[0]))
    radius, angle = thermal * np.sqrt(-2 * np.log1p(-u[2])), 2 * np.pi * u[3]
    if len(normal) == 2:
        tangent = np.stack([-normal[1], normal[0]])
        return np.asarray(along * normal + radius * np.cos(angle) * tangent)
    axis = np.abs(normal).argmin(axis=0)
    beside = np.eye(3)[:, axis] - normal[axis, np.arange(len(axis))] * normal
    beside /= np.sqrt((beside**2).sum(axis=0))
    other = np.cross(normal, beside, axis=0)
    across = np.cos(angle) * beside + np.sin(angle) * other
    return np.asarray(along * normal + radius * across)


def surfaces(
    spheres: Spheres, contacts: Contacts, leaving: Array, now: tuple[Array, Array] | None = None
) -> tuple[Array, Array]:
    """Velocity (d, N_c) and spin of the surface of each colloid.

    A contact of every particle, at r and with an impulse m_f (v - leaving - V_s - omega_s x r),
    brings the colloid from V and omega to V' and omega'. The exchange as a whole must see the means
    of both, or the colloid's temperature would come out too high: by half the fraction of its
    velocity that it loses in an interval if V_s was V. What comes sees the mean velocity W on the
    way of the interval, which between colloids that hold each other is not V. What leaves makes up
    for it: by the free-molecular friction of a sphere, 1 of what leaves and r = 1/3 + pi/6 of what
    comes (a disk: 1/2 + pi/4; Epstein, Phys. Rev. 23, 710, 1924), V_s = (1 + r) (V + V') / 2 - r W.
    What comes does not know of the spin: omega_s = (omega + omega') / 2.

    Between colloids that nearly touch, particles go to and fro. Each round of contacts changes the
    velocities as the first does, from what the rounds before left, `now`.
    """
    dimensions, colloids = spheres.positions.shape
    spins = len(spheres.spins)
    share = SHARES[dimensions]
    velocity, spin = np.empty_like(spheres.velocities), np.empty_like(spheres.spins)
    start, spinning = now or (spheres.velocities, spheres.spins)
    start = start + (2 * share - 1) * (start - spheres.ways)
    for c in range(colloids):
        mine = contacts.colloids == c
        arms, given = contacts.arms[:, mine], (contacts.velocities - leaving)[:, mine]
        inertia = np.repeat(
            [spheres.masses[c] / share, 2 * spheres.inertias[c]], [dimensions, spins]
        )
        matrix = np.diag(inertia)
        for column, motion in enumerate(np.eye(dimensions + spins)):
            of_surface = motion[:dimensions, None] + cross(
                np.broadcast_to(motion[dimensions:, None], (spins, arms.shape[1])), arms
            )
            matrix[:dimensions, column] += of_surface.sum(axis=1)
            matrix[dimensions:, column] += torque(arms, of_surface).sum(axis=1)
        right = inertia * np.concatenate([start[:, c], spinning[:, c]])
        right += np.concatenate([given.sum(axis=1), torque(arms, given).sum(axis=1)])
        motion = np.linalg.solve(matrix, right)
        velocity[:, c], spin[:, c] = motion[:dimensions], motion[dimensions:]
    return velocity, spin


def reflect(
    positions: Array,
    velocities: Array,
    spheres: Spheres,
    placement: Placement,
    interval: float,
    temperature: float,
    field: Array,
    boundaries: Boundaries,
    random: CounterRandom,
) -> tuple[Array, Array]:
    """Bring the fluid outside of the colloids, in place; what that gives to them.

    Args:
        positions, velocities: of the fluid, wrapped into the box (d, N).
        spheres: the colloids.
        placement: at the point of `entry`, or the `nearest`.
        interval: between collisions.
        temperature: kBT of the velocities that leave.
        field: acceleration of the fluid (d, 1).
        boundaries: the box.
        random: of the collision that follows.

    Returns:
        Momentum (d, N_c) and angular momentum of each colloid (as its spin).
    """
    particles = positions.shape[1]
    flown = np.full(particles, interval)
    momentum, angular = np.zeros_like(spheres.velocities), np.zeros_like(spheres.spins)
    for contact in range(MOST_CONTACTS):
        contacts = find_contacts(
            positions, velocities, flown, spheres, placement, interval, field, boundaries
        )
        if not contacts.particles.size:
            break
        leaving = thermal_velocities(contacts, temperature, contact, random, particles)
        now = (
            spheres.velocities + momentum / spheres.masses,
            spheres.spins + angular / spheres.inertias,
        )
        velocity, spin = surfaces(spheres, contacts, leaving, now)
        on = contacts.colloids
        left = leaving + velocity[:, on] + cross(spin[:, on], contacts.arms)
        impulses = contacts.velocities - left
        for component, impulse in zip(momentum, impulses, strict=True):
            component += np.bincount(on, impulse, len(component))
        for component, impulse in zip(angular, torque(contacts.arms, impulses), strict=True):
            component += np.bincount(on, impulse, len(component))
        start = spheres.positions[:, on] - contacts.left * spheres.ways[:, on]
        start += contacts.arms
        for axis in boundaries.walled:
            np.clip(start[axis], 0.0, boundaries.box[axis], out=start[axis])
        stream(start, left, field, contacts.left, boundaries)
        boundaries.wrap(start)
        positions[:, contacts.particles], velocities[:, contacts.particles] = start, left
        flown[contacts.particles] = contacts.left
    return momentum, angular
