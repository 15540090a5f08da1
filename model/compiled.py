# SPDX-License-Identifier: MIT
"""How numeric loops are compiled: cached on disk, without the GIL, dividing by zero as numpy does.

numba stores a compiled function beside its source and compiles it again when that file changes, not
when a file it calls into does: after editing one, remove the `__pycache__` folders of `model`.
"""

import numba

compiled = numba.njit(cache=True, nogil=True, error_model="numpy")
inlined = numba.njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
"""For the small parts of a hot loop: passing structures of arrays costs more than they do."""
