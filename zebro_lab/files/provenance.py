# SPDX-License-Identifier: MIT
"""Provenance of results: hashes of files, versions of software, and the commit it was made from.

The build (`hatch_build.py`) runs this file by its path, so it imports the standard library alone.
"""

import hashlib
import json
import os
import platform
import subprocess
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Final

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

    The commit has the form of `software_commit`.
    """
    return {
        "python": platform.python_version(),
        **{name: version(name) for name in RECORDED},
        "commit": software_commit(),
    }


BUILT_FROM: Final = "built_from.txt"
"""File beside this one with the commit, in built packages; a checkout has none."""
PACKAGES: Final = ("zebro_lab", "rig", "tracking", "model")
CHANGED: Final = " with uncommitted changes"
UNKNOWN: Final = "unknown: "

_MOST_SECONDS = 10.0


@cache
def software_commit() -> str:
    """Return the commit of the software that runs, as it was at the first call.

    Returns:
        The hash, 40 or 64 hexadecimal digits; then `CHANGED` if files of the packages differ from
        the commit. `UNKNOWN` and the reason if the commit cannot be known.
    """
    here = Path(__file__).resolve().parent
    try:
        return (here / BUILT_FROM).read_text(encoding="utf-8").strip()
    except FileNotFoundError:
        return commit_of(here.parents[1])
    except (OSError, UnicodeDecodeError) as error:
        return f"{UNKNOWN}{BUILT_FROM} cannot be read ({error})"


def commit_of(checkout: Path) -> str:
    """Return the commit of a checkout in the form of `software_commit`, by asking git.

    Args:
        checkout: Folder with `.git` and the folders of the packages.
    """
    if not (checkout / ".git").exists():
        return f"{UNKNOWN}the software is neither a git checkout nor was it built from one"
    try:
        told = _git_status(checkout)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"{UNKNOWN}git cannot be run ({error})"
    if told.returncode:
        return f"{UNKNOWN}git says: {' '.join(told.stderr.split())}"
    lines = told.stdout.splitlines()
    head = lines[0].removeprefix("# branch.oid ") if lines else ""
    if not head.isalnum():  # "(initial)"
        return f"{UNKNOWN}the checkout has no commit yet"
    return head + CHANGED * any(not line.startswith("#") for line in lines)


def _git_status(checkout: Path) -> subprocess.CompletedProcess[str]:
    """Ask git for the commit and the changed files of the packages, without writing anything.

    Variables of git's environment are left out: within a hook they name the repository of the hook.
    """
    outside = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
    asked = ("--no-optional-locks", "status", "--porcelain=v2", "--branch", "--", *PACKAGES)
    return subprocess.run(  # noqa: S603 - no shell, and no argument comes from outside
        ("git", "-C", str(checkout), *asked),  # noqa: S607 - wherever the user has git
        capture_output=True,
        check=False,
        encoding="utf-8",
        errors="replace",
        env=outside,
        timeout=_MOST_SECONDS,
    )
