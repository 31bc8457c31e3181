"""The files of a run directory and of a sweep (docs/run-directory.md): read with checks, written
whole.

Every file that we wrote once is read here, so that a damaged one is one line that names it. What a
file says reaches a path, LAMMPS or a calculation only after its check.

| module | holds |
|---|---|
| `manifest` | the system and the outputs of a run |
| `progress` | its newest checkpoint, what stopped it |
| `sweep_file` | the runs of a sweep |
| `names` | the names that become paths |
| `reading`, `writing` | text and JSON in, text out |
"""

from run_files.reading import RunDirectoryError

__all__ = ["RunDirectoryError"]
