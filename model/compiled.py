# SPDX-License-Identifier: MIT
"""Decorators that compile numeric loops: cached on disk, without the GIL, dividing as numpy does.

numba stores a compiled function beside its source and compiles it again when that file changes, but
not when a file that it calls changes. What is stored names the modules of the functions that it
calls and of the named tuples that it takes: it cannot be loaded when one of these has been renamed
or moved. After such an edit, remove the `__pycache__` folders of `model`.
"""

import numba

compiled = numba.njit(cache=True, nogil=True, error_model="numpy")
"""Decorator for numeric functions: compiled, cached on disk, without the GIL, 1/0 is infinite."""
# numba compiles its own loops of this kind with `_nrt`; its type stubs lack the option.
borrowing = numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)  # pyright: ignore[reportCallIssue]
"""Decorator for hot loops that allocate no arrays: as `compiled`, without reference counting.

With reference counting, every row that is read of an array increments and decrements a count. This
takes half of a walk's time, and threads that share a table contend for the table's count.
"""
inlined = numba.njit(  # pyright: ignore[reportCallIssue]
    cache=True, nogil=True, error_model="numpy", forceinline=True, _nrt=False
)
"""Decorator for small functions of a hot loop: as `borrowing`, and inlined into their callers.

Passing structures of arrays would take longer than the functions themselves.
"""
