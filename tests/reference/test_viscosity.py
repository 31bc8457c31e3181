"""Viscosity of the bulk fluid against kinetic theory, over density, angle and mean free path.

python -m pytest -m statistics -s tests/reference/test_viscosity.py
"""

import math

import numpy as np

from lammps_inputs import Bulk
from lammps_inputs.viscosity import viscosity
from srd_driver.reference import ReferenceEngine

SEED = 1
KICK_INTERVAL = 5  # collisions; longer than the memory of the stress


def measured_viscosity(scene: Bulk, relative_error: float) -> tuple[float, float]:
    """Viscosity and its standard error from a shear wave that kicks keep at its amplitude A.

    With a = (2 / N) sum v_x sin(k y), one interval is a' = exp(-nu k^2 Delta) (a + kick) + xi, xi
    the white thermal noise. Its regression gives nu; the error is that of the block sums of the
    residuals. The run is as long as theory says that the error wanted takes:
    4 / (N A^2 nu k^2 error^2).
    """
    theory = viscosity(
        scene.density, scene.collision_time, scene.angle, scene.dimensions, scene.rotation
    )
    k = 2 * np.pi / scene.width
    amplitude, interval = scene.shear_wave, KICK_INTERVAL * scene.collision_time
    kick = amplitude * math.expm1(theory * k**2 * interval)
    duration = 4 / (scene.fluid_particles * amplitude**2 * theory * k**2 * relative_error**2)

    engine = ReferenceEngine(scene)
    engine.advance(4 * KICK_INTERVAL)
    before, after = [], []
    for _ in range(math.ceil(duration / interval)):
        wave = np.sin(k * engine.fluid_positions[:, 1])
        engine.fluid_velocities[:, 0] += kick * (wave - wave.mean())
        after.append(2 * np.mean(engine.fluid_velocities[:, 0] * wave))
        engine.advance(KICK_INTERVAL)
        wave = np.sin(k * engine.fluid_positions[:, 1])
        before.append(2 * np.mean(engine.fluid_velocities[:, 0] * wave))
    x, y = np.array(after), np.array(before)
    decay = (x @ y) / (x @ x)
    blocks = np.array_split(x * (y - decay * x), 40)
    decay_error = np.sqrt(np.sum([block.sum() ** 2 for block in blocks])) / (x @ x)
    rate = k**2 * interval
    return -math.log(decay) / rate, decay_error / decay / rate


def bulk(dimension: int, density: float, angle: float, collision_time: float, **more: str) -> Bulk:
    """A wave long enough, and slow enough, for corrections in k and shear rate below the errors."""
    kinetic = collision_time >= 0.5
    return Bulk.make(
        dimension=dimension,
        length=32 if dimension == 2 else 12,
        width=64 if kinetic else 48,
        height=None if dimension == 2 else 12,
        density=density,
        angle=angle,
        collision_time=collision_time,
        shear_wave=0.5 if kinetic else 1.0,
        thermostat="layer",
        sampling_interval=collision_time,
        seed=SEED,
        **more,
    )
