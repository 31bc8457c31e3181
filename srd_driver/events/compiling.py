"""How the functions of this folder are compiled.

Machine code is kept beside the source. It is keyed by the source file of the outermost function, so
that a changed `inlined` one is only seen once `kernel.py` is touched (see docs/events.md).
"""

from functools import partial

from numba import njit

compiled = partial(njit, cache=True, _nrt=False, error_model="numpy")
inlined = partial(compiled, inline="always")
