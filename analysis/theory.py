"""What kinetic theory says of the MPC fluid."""

import math


def kinematic_viscosity(
    density: float, collision_time: float, angle: float, dimension: int
) -> float:
    """Kinematic viscosity of the MPC fluid with Poisson-distributed cells [a0^2/t0].

    2D: nu_coll + nu_kin of tabatabaei-2009 (3.16). 3D with rotations by 90 degrees about the
    coordinate axes: hecht-2005 (28), its kinetic factor (M+2)/(4(M-1)) of a fixed number M in a
    cell replaced by (1+2q)/(4(1-q)), q = (1 - e^-M)/M, which holds for small M too.

    Args:
        density: particles per cell, n_f or M [1/a0^d].
        collision_time: tau_c [t0].
        angle: rotation angle alpha [degrees].
        dimension: 2 or 3.

    Raises:
        ValueError: where neither equation applies (3D and not 90 degrees; 2D and 180 degrees,
            where nu_kin diverges).
    """
    q = (1 - math.exp(-density)) / density
    if dimension == 3:
        if angle != 90:
            raise ValueError(f"no equation for a 3D rotation by {angle:g} degrees")
        return (1 - q) / (18 * collision_time) + collision_time * (1 + 2 * q) / (4 * (1 - q))
    if angle == 180:
        raise ValueError("the kinetic viscosity diverges at 180 degrees")
    cosine = math.cos(math.radians(angle))
    collisional = (1 - cosine) / (12 * collision_time) * (1 - q)
    double_angle = 1 - math.cos(2 * math.radians(angle))
    return collisional + collision_time * (1 / (double_angle * (1 - q)) - 0.5)
