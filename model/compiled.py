# SPDX-License-Identifier: MIT
"""Decorators that compile numeric loops: cached on disk, without the GIL, dividing as numpy does.

numba stores a compiled function beside its source and compiles it again when that file changes, but
not when a file that it calls changes. What is stored names the modules of the functions that it
calls and of the named tuples that it takes: it cannot be loaded when one of these has been renamed
or moved. Therefore all that is stored beside the sources is deleted when one of them has changed.
"""

from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import numba


def delete_stale_loops(package: Path) -> None:
    """Delete numba's cache in a package's folder if a source with compiled functions has changed.

    A digest of these sources is kept in the package's `__pycache__`. Constants that a compiled
    function takes from other sources are not in it.

    Args:
        package: Folder of the package.
    """
    digest = sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"numba" in source or b"model.compiled" in source:
            digest.update(str(path.relative_to(package)).encode() + source)
    known = package / "__pycache__" / "compiled_sources.sha256"
    with suppress(OSError):  # a folder that cannot be written: numba's cache is elsewhere
        if known.is_file() and known.read_text(encoding="utf-8") == digest.hexdigest():
            return
        for stored in package.rglob("*.nb[ic]"):
            stored.unlink(missing_ok=True)
        known.parent.mkdir(exist_ok=True)
        known.write_text(digest.hexdigest(), encoding="utf-8")


def _can_be_stored() -> bool:
    """Return whether there is a folder in which numba can store compiled functions.

    There is none where neither the package nor the user's home can be written.
    """
    try:
        numba.njit(cache=True)(_can_be_stored)
    except RuntimeError:
        return False
    return True


delete_stale_loops(Path(__file__).parent)
_STORED = _can_be_stored()

compiled = numba.njit(cache=_STORED, nogil=True, error_model="numpy")
"""Decorator for numeric functions: compiled, cached on disk, without the GIL, 1/0 is infinite."""
# numba compiles its own loops of this kind with `_nrt`; its type stubs lack the option.
borrowing = numba.njit(cache=_STORED, nogil=True, error_model="numpy", _nrt=False)  # pyright: ignore[reportCallIssue]
"""Decorator for hot loops that allocate no arrays: as `compiled`, without reference counting.

With reference counting, every row that is read of an array increments and decrements a count. This
takes half of a walk's time, and threads that share a table contend for the table's count.
"""
inlined = numba.njit(  # pyright: ignore[reportCallIssue]
    cache=_STORED, nogil=True, error_model="numpy", forceinline=True, _nrt=False
)
"""Decorator for small functions of a hot loop: as `borrowing`, and inlined into their callers.

Passing structures of arrays would take longer than the functions themselves.
"""
