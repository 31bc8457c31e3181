"""Kinetic temperature relative to the stream of each species."""

from analysis import correlated_mean
from analysis.findings import Findings
from analysis.kinetic_temperature import stream_temperature
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("stream_temperature",)


def measure(run: RunDirectory) -> Findings:
    """Its mean over time."""
    particles = run.particles()
    velocities = particles.velocities[sampled_frames(run)]
    masses = [species.mass for species in run.manifest.system.species for _ in range(species.count)]
    series = stream_temperature(velocities, particles.species, masses)
    return Findings({"stream_temperature": correlated_mean.mean(series).as_json()})
