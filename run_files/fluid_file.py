"""The fluid as `fix_modify ID save FILE` of fix mpc leaves it (docs/fix_mpc.md)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from run_files.reading import refuse

MAGIC = b"mpcfluid"
HEADER_BYTES = 32  # MAGIC, then dimension, particles and collisions as 64-bit integers


@dataclass(frozen=True)
class Fluid:
    """All particles of an MPC fluid, by their numbers.

    Attributes:
        positions: (N, d) [a0].
        velocities: (N, d) [a0/t0].
    """

    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]


def read_fluid(path: str | Path) -> Fluid:
    """The fluid of a file.

    Raises:
        RunDirectoryError: when it is missing, or no whole fluid.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        refuse(path, error.strerror or error)
    if content[: len(MAGIC)] != MAGIC or len(content) < HEADER_BYTES:
        refuse(path, "not a fluid of fix mpc")
    dimensions, count, _ = map(int, np.frombuffer(content[len(MAGIC) : HEADER_BYTES], dtype="<i8"))
    width = 1 + 2 * dimensions
    if dimensions not in (2, 3) or len(content) - HEADER_BYTES != 8 * width * count:
        refuse(
            path, f"{len(content)} bytes do not hold {count} particles in {dimensions} dimensions"
        )
    rows = np.frombuffer(content[HEADER_BYTES:], dtype="<f8").reshape(count, width)
    rows = rows[np.argsort(rows[:, 0])]
    if not np.array_equal(rows[:, 0], np.arange(count)) or not np.isfinite(rows).all():
        refuse(path, "its particles are not numbered from 0 on, or not all finite")
    return Fluid(rows[:, 1 : 1 + dimensions].copy(), rows[:, 1 + dimensions :].copy())
