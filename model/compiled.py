# SPDX-License-Identifier: MIT
"""Decorators that compile numeric loops: cached on disk, without the GIL, dividing as numpy does.

numba stores a compiled function in `__pycache__` and compiles the function again when its file
changes, but not when the file of a function that it calls changes. The stored code names the
modules of called functions and of named tuples in the arguments, and cannot be loaded when one of
these modules has been renamed or moved. After either edit, remove the `__pycache__` folders of
`model`.
"""

import numba

compiled = numba.njit(cache=True, nogil=True, error_model="numpy")
# numba compiles its own loops of this kind with `_nrt`; its type stubs lack the option.
borrowing = numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)  # pyright: ignore[reportCallIssue]
"""Decorator for hot loops that allocate no arrays: without reference counting.

With reference counting, every row of an array that is accessed increments and decrements a count,
which takes half of a walk's time; threads that share a table contend for its count.
"""
inlined = numba.njit(  # pyright: ignore[reportCallIssue]
    cache=True, nogil=True, error_model="numpy", forceinline=True, _nrt=False
)
"""Decorator for small functions of a hot loop, inlined and without reference counting.

Passing structures of arrays would take longer than the functions themselves.
"""
