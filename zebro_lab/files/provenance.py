# SPDX-License-Identifier: MIT
"""Provenance of results: hashes of files, versions of software."""

import hashlib
import json
import platform
from collections.abc import Iterable, Mapping
from importlib.metadata import version
from pathlib import Path

from zebro_lab.files.commit import software_commit

RECORDED = ("zebro-lab", "numpy", "scipy", "emcee", "arviz-stats", "numba")


def file_hash(path: Path) -> str:
    """Compute the SHA-256 of a file's content, in hexadecimal; OSError if it cannot be read."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def file_hashes(paths: Iterable[Path]) -> dict[str, str]:
    """Compute the SHA-256 of each file, as `file_hash` does, by its path as given."""
    return {str(path): file_hash(path) for path in paths}


def fingerprint(hashes: Mapping[str, str], settings: Mapping[str, object]) -> str:
    """Compute the SHA-256 of data and settings, independent of names and order of the files.

    Args:
        hashes: SHA-256 of each data file; only the hashes count, not the keys.
        settings: All settings that affect the results, JSON-serialisable.
    """
    content = {"data": sorted(hashes.values()), "settings": dict(settings)}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def software() -> dict[str, str]:
    """Return the versions of Python and of the packages in `RECORDED`, and our `commit`, by name.

    The commit has the form of `zebro_lab.files.commit.software_commit`.
    """
    return {
        "python": platform.python_version(),
        **{name: version(name) for name in RECORDED},
        "commit": software_commit(),
    }
