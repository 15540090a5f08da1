# SPDX-License-Identifier: MIT
"""How numeric loops are compiled: cached on disk, without the GIL, dividing by zero as numpy does.

numba stores a compiled function beside its source and compiles it again when that file changes, not
when a file it calls into does: after editing one, remove the `__pycache__` folders of `model`.
"""

import numba

compiled = numba.njit(cache=True, nogil=True, error_model="numpy")
# `_nrt` is what numba compiles its own such loops with; its stubs leave it out.
borrowing = numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)  # pyright: ignore[reportCallIssue]
"""For hot loops on arrays that their caller made: none of their own, and no references counted.

Every row taken of an array counts a reference up and down again: half of a walk's time, and threads
that walk by one table wait for each other's counts.
"""
inlined = numba.njit(  # pyright: ignore[reportCallIssue]
    cache=True, nogil=True, error_model="numpy", forceinline=True, _nrt=False
)
"""For the small parts of a hot loop, which borrow too: passing structures of arrays costs more than
they do."""
