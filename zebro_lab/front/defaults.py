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
    """A watcher that shows no progress and never asks to stop."""

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
    """Return a path that may be None."""
    return None if path is None else Path(path)


@contextmanager
def kept_or_temporary(out: PathLike | None) -> Iterator[Path]:
    """Yield the folder to write, or one that is removed afterwards if it is None."""
    if out is not None:
        yield Path(out)
        return
    with TemporaryDirectory() as temporary:
        yield Path(temporary) / "result"
