# SPDX-License-Identifier: MIT
"""Remove folders that a failed command has created and left empty."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def removing_new_folders(folder: Path) -> Iterator[None]:
    """Remove a folder, and those it lies in, if the body fails; not those that exist before.

    A folder that is not empty stays, whoever has written into it.

    Args:
        folder: Folder that the body creates where it is missing.
    """
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        yield
    except BaseException:
        for each in missing:
            with suppress(OSError):  # it is not empty, or was not created
                each.rmdir()
        raise
