# SPDX-License-Identifier: MIT
"""Write files and folders atomically, complete or not at all, with signals put off meanwhile."""

import os
import secrets
import shutil
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from model.file_lock import try_lock
from zebro_lab.files.errors import AlreadyExists


def atomic_write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write a file atomically: a reader sees the old content or the complete new content.

    Args:
        path: File to write; its folder must exist. A symbolic link is replaced, not its target.
        data: The complete content of the file.

    Returns:
        The path written.

    Raises:
        OSError: The file cannot be written; an old content is unchanged.
    """
    target = Path(path)
    draft = target.with_name(draft_name(target))
    try:
        with naming(target), draft.open("xb") as file:
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
        text: The complete content of the file; line endings are not translated.

    Returns:
        The path written.

    Raises:
        OSError: The file cannot be written; an old content is unchanged.
    """
    return atomic_write_bytes(path, text.encode())


@contextmanager
def atomic_folder(target: str | os.PathLike[str]) -> Iterator[Path]:
    """Create a folder atomically: it appears complete or, after any exception, not at all.

    The body writes into a hidden draft folder in the nearest existing parent, which is renamed at
    the end. Folders that may replace an earlier result are written with
    `zebro_lab.files.result_folder.result_folder`.

    Args:
        target: Folder to create; an empty one may exist; missing parents are created.

    Yields:
        The empty draft folder to write into.

    Raises:
        AlreadyExists: The target is a file, or a folder that is not empty, at the start or end.
        OSError: The draft or a parent cannot be created, or the draft cannot be renamed.
    """
    folder = Path(target).absolute()
    _require_empty(folder, target)
    with naming(folder), draft_folder(folder) as draft:
        yield draft
        sync_files(draft)
        _require_empty(folder, target)
        folder.parent.mkdir(parents=True, exist_ok=True)
        draft.replace(folder)
        sync_folder(folder.parent)


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Add a path to an `OSError` of the body that names no file, such as that of a full disk."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            error.filename = str(path)
        raise


@contextmanager
def draft_folder(folder: Path) -> Iterator[Path]:
    """Create and lock a hidden draft for a folder during the body; remove it at the end.

    Unlocked drafts beside it, which killed processes have left, are removed first.
    """
    ground = nearest_folder(folder)
    for stale in ground.glob(f".*.{8 * '[0-9a-f]'}.part"):
        with _lock_of(stale) as is_stale:
            if is_stale and stale.is_dir():
                shutil.rmtree(stale, ignore_errors=True)
    draft = ground / draft_name(folder)
    try:
        draft.mkdir()
        with _lock_of(draft):
            yield draft
    finally:
        shutil.rmtree(draft, ignore_errors=True)


@contextmanager
def _lock_of(draft: Path) -> Iterator[bool]:
    """Lock a draft during the body; yield whether the lock was free, False on any OSError."""
    handle = -1
    is_free = False
    with suppress(OSError):
        handle = os.open(draft, os.O_RDONLY)
        is_free = try_lock(handle)
    try:
        yield is_free
    finally:
        if handle >= 0:
            os.close(handle)


def nearest_folder(path: Path) -> Path:
    """Return the nearest existing parent folder of a path, not itself, where drafts are created.

    A draft there is on the same file system as the path, so that it can be renamed to it, and no
    parent folder has to be created first.
    """
    return next(parent for parent in path.parents if parent.is_dir())


def draft_name(path: Path) -> str:
    """Return a random hidden file name for a draft of a path, `.NAME.XXXXXXXX.part`."""
    return f".{path.name}.{secrets.token_hex(4)}.part"


def sync_files(folder: Path) -> None:
    """Flush every file in a folder and its subfolders, not the folders, to disk (fsync)."""
    for path in folder.rglob("*"):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())


def sync_folder(folder: Path) -> None:
    """Flush a folder's list of entries to disk (fsync); errors of the file system are ignored."""
    # A folder may be writable but not listed, and some network file systems cannot fsync one.
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _require_empty(folder: Path, target: object) -> None:
    """Raise `AlreadyExists` if a path is a file or a folder with content.

    `target` is the path as the user named it, for the message.
    """
    if folder.exists() and not folder.is_dir():
        raise AlreadyExists(f"{target} is a file, expected a new folder; choose another name")
    if folder.is_dir() and any(folder.iterdir()):
        raise AlreadyExists(f"{target} exists already and is not empty; choose another name")


_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put off SIGINT and SIGTERM until the end of the body; if it raises, they are dropped.

    Imports of C extensions are put into such a body too, since an exception such as
    KeyboardInterrupt within their initialisation can abort Python.
    Python runs handlers of signals in the main thread alone; in other threads, and of signals
    without a handler, nothing is done.
    """
    is_main = threading.current_thread() is threading.main_thread()
    heard = [number for number in _SIGNALS if is_main and callable(signal.getsignal(number))]
    came: list[int] = []
    earlier = {
        number: signal.signal(number, lambda number, _: came.append(number)) for number in heard
    }
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
    for number in dict.fromkeys(came):
        signal.raise_signal(number)
