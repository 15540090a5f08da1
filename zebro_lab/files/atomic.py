# SPDX-License-Identifier: MIT
"""Files and folders that appear finished or not at all."""

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from zebro_lab.files.errors import AlreadyExists


def atomic_write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write a file so that a reader sees the old one or the whole new one.

    Args:
        path: File to write; its folder must exist.
        data: Its content.

    Returns:
        The path written.
    """
    target = Path(path)
    draft = target.with_name(draft_name(target))
    try:
        with draft.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(target)
        sync_folder(target.parent)
    finally:
        draft.unlink(missing_ok=True)
    return target


def atomic_write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write a UTF-8 text file as `atomic_write_bytes` does; line ends stay as they are."""
    return atomic_write_bytes(path, text.encode())


@contextmanager
def atomic_folder(target: str | os.PathLike[str]) -> Iterator[Path]:
    """Fill a new folder so that it appears finished or, after any exception, not at all.

    The body writes into a hidden folder beside the target. What may replace an earlier result is
    written with `zebro_lab.files.result_folder`.

    Args:
        target: Folder to make, or an empty one; missing parents are made.

    Yields:
        Folder to write into, empty.

    Raises:
        AlreadyExists: The target is a file, or a folder that holds something.
    """
    folder = Path(target).absolute()
    _require_empty(folder, target)
    draft = nearest_folder(folder) / draft_name(folder)
    draft.mkdir()
    try:
        yield draft
        sync_files(draft)
        _require_empty(folder, target)
        folder.parent.mkdir(parents=True, exist_ok=True)
        draft.replace(folder)
        sync_folder(folder.parent)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def nearest_folder(path: Path) -> Path:
    """Return the nearest folder above a path that exists: drafts lie there.

    It is on the same file system, and there is no parent to clean up.
    """
    return next(parent for parent in path.parents if parent.is_dir())


def draft_name(path: Path) -> str:
    """Name a hidden draft beside a path, anew at each call."""
    return f".{path.name}.{secrets.token_hex(4)}.part"


def sync_files(folder: Path) -> None:
    """Bring every file below a folder to the disk."""
    for path in folder.rglob("*"):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())


def sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk, where the file system can."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:  # a folder that may be written to but not listed
        return
    try:
        os.fsync(handle)
    except OSError:  # some network file systems refuse to do so with a folder
        return
    finally:
        os.close(handle)


def _require_empty(folder: Path, target: object) -> None:
    if folder.exists() and not folder.is_dir():
        raise AlreadyExists(f"{target} is a file where a folder is to be written; name another")
    if folder.is_dir() and any(folder.iterdir()):
        raise AlreadyExists(f"{target} exists already and holds something; name another")
