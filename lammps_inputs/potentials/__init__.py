"""Potentials, each once: numpy energy and force beside its LAMMPS lines, one file each.

Distances in a0, energies in kBT. Tests hold both forms together through LAMMPS itself.
"""
