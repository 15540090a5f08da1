# SPDX-License-Identifier: MIT
"""Write files and folders atomically: they appear complete or not at all."""

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from zebro_lab.files.errors import AlreadyExists


def atomic_write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write a file atomically: a reader sees the old content or the complete new content.

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
    """Write a UTF-8 text file atomically, as `atomic_write_bytes` does.

    Args:
        path: File to write; its folder must exist.
        text: Its content; line endings are not translated.

    Returns:
        The path written.
    """
    return atomic_write_bytes(path, text.encode())


@contextmanager
def atomic_folder(target: str | os.PathLike[str]) -> Iterator[Path]:
    """Create a folder atomically: it appears complete or, after any exception, not at all.

    The body writes into a hidden draft folder beside the target, which is renamed at the end.
    Folders that may replace an earlier result are written with
    `zebro_lab.files.result_folder.result_folder`.

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
    """Return the nearest existing parent folder of a path, where drafts are created.

    It is on the same file system, so that a draft can be renamed to its target, and no parent
    folder has to be created first.
    """
    return next(parent for parent in path.parents if parent.is_dir())


def draft_name(path: Path) -> str:
    """Return a unique hidden file name for a draft of a path."""
    return f".{path.name}.{secrets.token_hex(4)}.part"


def sync_files(folder: Path) -> None:
    """Flush every file below a folder to disk (fsync)."""
    for path in folder.rglob("*"):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())


def sync_folder(folder: Path) -> None:
    """Flush the entries of a folder to disk (fsync), if the file system supports it."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:  # a folder that may be written to but not listed
        return
    try:
        os.fsync(handle)
    except OSError:  # some network file systems cannot fsync a folder
        return
    finally:
        os.close(handle)


def _require_empty(folder: Path, target: object) -> None:
    if folder.exists() and not folder.is_dir():
        raise AlreadyExists(f"{target} is a file where a folder is to be written; name another")
    if folder.is_dir() and any(folder.iterdir()):
        raise AlreadyExists(f"{target} exists already and holds something; name another")
