# SPDX-License-Identifier: MIT
"""Defaults of the functions for notebooks: no progress shown, no files kept."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeAlias

PathLike: TypeAlias = str | os.PathLike[str]


class Silent:
    """A watcher that shows no progress and never requests a stop."""

    def step(self, what: str, fraction: float | None) -> None:
        """Ignore a progress report.

        Args:
            what: Name of the task.
            fraction: Share of the task that is done, 0 to 1 [-]; None when unknown.
        """

    def stop_requested(self) -> bool:
        """Return False."""
        return False


def optional(path: PathLike | None) -> Path | None:
    """Convert a path or string to a `Path`; None stays None."""
    return None if path is None else Path(path)


@contextmanager
def kept_or_temporary(out: PathLike | None) -> Iterator[Path]:
    """Yield `out` as a path; if None, a path to create in a temporary folder, then removed."""
    if out is not None:
        yield Path(out)
        return
    with TemporaryDirectory() as temporary:
        yield Path(temporary) / "result"
