"""freud, loaded so that it calls its own Voronoi construction.

LAMMPS shows its symbols to every library of the process, another version of voro++ among them: what
is loaded later would call that one, and crash.
"""

import os
import sys

_flags = sys.getdlopenflags()
sys.setdlopenflags(os.RTLD_NOW | getattr(os, "RTLD_DEEPBIND", 0))
try:
    import freud
finally:
    sys.setdlopenflags(_flags)

__all__ = ["freud"]
