# SPDX-License-Identifier: MIT
"""Find duplicate data: files with the same content, or the same samples imported twice."""

import hashlib
import re
from collections.abc import Callable, Hashable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_unpacked
from zebro_lab.files.provenance import file_hash

FEWEST: Final = 20
"""Fewest samples of a run whose forces identify it; fewer may be equal by chance."""
_SHOWN: Final = 3
_COPY: Final = re.compile(r"\b(copy|kopie|copie|copia)\b|\(\d+\)$", re.IGNORECASE)
_T = TypeVar("_T")


def content_hash(file: Path) -> str:
    """Compute the SHA-256 of a file's content, which is the same for a table and its gzipped copy.

    A file named `.gz` is unpacked first. If it is damaged, or larger than a table may be, its
    compressed bytes are hashed instead of raising: the error is reported where the file is read.
    """
    if file.name.lower().endswith(".gz"):
        with suppress(DataError):
            return hashlib.sha256(read_unpacked(file)).hexdigest()
    return file_hash(file)


def array_hash(*arrays: Array) -> str:
    """Compute one SHA-256 of the shapes and float64 values of arrays, in order."""
    digest = hashlib.sha256()
    for each in arrays:
        digest.update(str(each.shape).encode())
        digest.update(np.ascontiguousarray(each, dtype="<f8").tobytes())
    return digest.hexdigest()


def run_keys(forces: Sequence[Array], run: NDArray[np.intp], n_runs: int) -> tuple[str, ...]:
    """Compute a key per run of a table, in order of run; duplicate runs have equal keys.

    The key is a hash of the forces, independent of names and slip definitions: two recordings never
    have exactly equal forces. The key of a run with fewer than `FEWEST` samples or constant forces
    is the hash of all forces of the table, with the run's index, which only the same run of an
    equal table has.

    Args:
        forces: Columns of forces, each of shape (n,) [N].
        run: Index of the run of each sample, from 0, shape (n,).
        n_runs: Number of runs.
    """
    whole = array_hash(*forces)
    order = np.argsort(run, kind="stable")
    bounds = np.searchsorted(run[order], np.arange(n_runs + 1))
    keys = []
    for index in range(n_runs):
        rows = order[bounds[index] : bounds[index + 1]]
        part = [column[rows] for column in forces]
        identified = len(part[0]) >= FEWEST and any(np.ptp(column) > 0 for column in part)
        keys.append(array_hash(*part) if identified else f"{whole} {index}")
    return tuple(keys)


def named_like_a_copy(path: Path) -> bool:
    """Return whether a file or folder has a name as computers give to copies.

    >>> [named_like_a_copy(Path(n)) for n in ("b - Kopie.csv", "b (1).csv", "b copy 2", "b.csv")]
    [True, True, True, False]
    """
    return _COPY.search(path.name.split(".")[0]) is not None


def first_of_each(
    items: Sequence[_T],
    *,
    key: Callable[[_T], Hashable],
    is_copy: Callable[[_T], bool] = lambda _: False,
) -> tuple[list[_T], list[tuple[_T, _T]]]:
    """Remove duplicates: of the items of one key, keep the first that is no copy, else the first.

    Args:
        items: Items in order; the same object again is dropped without a pair.
        key: Returns the key by which two items are duplicates.
        is_copy: Returns whether an item is a copy rather than the original, as its name may tell.
            The item kept stands where the first of its key stood.

    Returns:
        The items kept, and pairs (duplicate, item kept), both in order.

    >>> first_of_each(["a.csv", "b.csv", "A.csv"], key=str.lower)
    (['a.csv', 'b.csv'], [('A.csv', 'a.csv')])
    """
    first: dict[Hashable, _T] = {}
    repeated: list[tuple[_T, _T]] = []
    for item in items:
        known = first.setdefault(key(item), item)
        if known is item:
            continue
        if is_copy(known) and not is_copy(item):
            first[key(item)] = item
            item, known = known, item
        repeated.append((item, known))
    return list(first.values()), repeated


def duplicates_note(what: str, repeated: Sequence[tuple[object, object]]) -> tuple[str, ...]:
    """Format a note on duplicates that were dropped, with the first three pairs.

    Args:
        what: Plural noun for the items.
        repeated: Pairs (duplicate, item kept).

    Returns:
        One line; empty if there are no duplicates.

    >>> duplicates_note("tables", [("b.csv", "a.csv")])
    ('1 of the tables is a duplicate and was ignored: b.csv equals a.csv',)
    """
    if not repeated:
        return ()
    shown = ", ".join(f"{one} equals {other}" for one, other in repeated[:_SHOWN])
    more = f" and {len(repeated) - _SHOWN} more" if len(repeated) > _SHOWN else ""
    verb = "is a duplicate and was" if len(repeated) == 1 else "are duplicates and were"
    return (f"{len(repeated)} of the {what} {verb} ignored: {shown}{more}",)
