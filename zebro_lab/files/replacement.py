# SPDX-License-Identifier: MIT
"""Replace a folder atomically: a killed process leaves either the old or the new one complete.

| step | on disk | killed after it |
|---|---|---|
| the user's files are linked into the draft | NAME old | NAME is old |
| NAME becomes `.NAME.previous` | only the old one | the next reader or writer restores it |
| files that the user wrote meanwhile are linked | only the old one | likewise |
| the draft becomes NAME | both | NAME is new; the next reader or writer removes the old |
| the old one is removed | NAME new | NAME is new |

NAME is the folder. The file `.NAME.replacing` is locked meanwhile, so that no other process
restores.
"""

import logging
import os
import shutil
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

from model.file_lock import try_lock
from zebro_lab.files.atomic import sync_folder, uninterrupted
from zebro_lab.files.errors import AlreadyExists, DataError

PATIENCE: Final = 10.0
"""Timeout for another process that replaces the same folder [s]."""
_LOG = logging.getLogger(__name__)


def previous_of(folder: Path) -> Path:
    """Return the path `.NAME.previous`, where the old folder is kept during a replacement."""
    return folder.with_name(f".{folder.name}.previous")


def replace_folder(folder: Path, draft: Path, *, owned: Callable[[], Collection[str]]) -> None:
    """Replace a folder by a draft atomically, keeping the user's files: those not in `owned`.

    Args:
        folder: Folder to create or to replace; not a symbolic link.
        draft: The new folder, on the same file system, which is renamed to `folder`.
        owned: Returns the files of the old folder to leave out, as paths relative to it, or raises.
            It is called while the lock is held, so that the list is still valid when it is used.

    Raises:
        AlreadyExists: Another process still replaces it after `PATIENCE`.
        OSError: A folder cannot be moved or written: the old one is unchanged.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    with _locked(folder):
        _recover_locked(folder)
        names = frozenset(owned())
        if folder.exists():
            _carry(folder, draft, names)
            draft.chmod(folder.stat().st_mode & 0o7777)
        with uninterrupted():
            _swap(folder, draft, names)
            shutil.rmtree(previous_of(folder), ignore_errors=True)  # else the next one tries again


def recover(path: Path) -> Path:
    """Restore a result folder after a killed replacement that left only `.NAME.previous`.

    Where NAME exists, it is complete: what is left of `.NAME.previous` is removed, if possible.
    Every reader and writer of a result calls this function first.

    Args:
        path: Folder of a result, or a file in it.

    Returns:
        The path, as given.

    Raises:
        DataError: NAME does not exist, and `.NAME.previous` cannot be renamed to it.
        AlreadyExists: NAME does not exist, and another process still replaces it after `PATIENCE`.
    """
    absolute = Path(os.path.realpath(path))
    for folder in (absolute, absolute.parent):
        if not folder.name or not previous_of(folder).is_dir():
            continue
        try:
            with _locked(folder):
                _recover_locked(folder)
        except OSError as error:
            if folder.exists():
                continue
            if isinstance(error, AlreadyExists):
                raise
            raise DataError(
                f"is missing: a replacement was interrupted, and {previous_of(folder).name} cannot "
                f"be renamed back ({error.strerror}); rename it to {folder.name} by hand",
                file=folder,
            ) from error
    return path


def _recover_locked(folder: Path) -> None:
    """Undo a replacement that was killed if NAME is missing, else remove the old folder."""
    previous = previous_of(folder)
    if not previous.is_dir():
        return
    if folder.exists():
        shutil.rmtree(previous, ignore_errors=True)
        return
    previous.rename(folder)
    sync_folder(folder.parent)
    _LOG.warning(
        "%s was restored from %s, which an interrupted replacement had left", folder, previous.name
    )


def _swap(folder: Path, draft: Path, owned: Collection[str]) -> None:
    """Move the old folder aside and the draft to its place; move the old one back if that fails.

    In between, files that the user wrote since the draft was filled are linked into it.
    """
    previous = previous_of(folder)
    if folder.exists():
        folder.rename(previous)
    try:
        if previous.exists():
            _carry(previous, draft, owned)
        _sync(draft)
        draft.rename(folder)
    except OSError:
        if previous.exists():
            previous.rename(folder)
        raise
    sync_folder(folder.parent)


def _carry(old: Path, new: Path, owned: Collection[str], prefix: str = "") -> None:
    """Hard-link the user's files, names not in `owned`, from the old folder into the new one.

    Files are copied where the file system, or their owner, forbids links. A file that the new
    folder has already stays as it is there unless it is older. `prefix` is the path of `old`
    relative to the folder that is replaced, with a final `/`; names in `owned` begin with it.
    """
    for path in sorted(old.iterdir()):
        name, target = prefix + path.name, new / path.name
        if name in owned:
            continue
        if not _is_folder(path):
            _link(path, target)
            continue
        target.mkdir(exist_ok=True)
        target.chmod(path.stat().st_mode & 0o7777)
        _carry(path, target, owned, f"{name}/")
        is_emptied = any(each.startswith(f"{name}/") for each in owned)
        if is_emptied and not any(target.iterdir()):
            target.rmdir()


def _is_folder(path: Path) -> bool:
    """Return whether a path is a folder and no link to one."""
    return path.is_dir() and not path.is_symlink()


def _link(file: Path, target: Path) -> None:
    """Hard-link a file to a target, or copy it where that is not possible.

    A target that exists stays unless it is older than the file.
    """
    if os.path.lexists(target):
        if target.lstat().st_mtime_ns >= file.lstat().st_mtime_ns:
            return
        target.unlink()
    try:
        os.link(file, target, follow_symlinks=False)
    except OSError:
        shutil.copy2(file, target, follow_symlinks=False)
        if not target.is_symlink():
            with target.open("rb") as copied:
                os.fsync(copied.fileno())


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Lock `.NAME.replacing` during the body, and remove it at the end.

    Raises:
        AlreadyExists: Another process still holds the lock after `PATIENCE`.
        OSError: The file cannot be opened.
    """
    path, deadline = folder.with_name(f".{folder.name}.replacing"), time.monotonic() + PATIENCE
    while True:
        with path.open("ab") as lock:
            if try_lock(lock.fileno()) and _is_at(lock, path):
                try:
                    yield
                finally:
                    path.unlink(missing_ok=True)
                return
        if time.monotonic() > deadline:
            raise AlreadyExists(
                f"{folder} is being replaced by another process; try again when that process ends"
            )
        time.sleep(0.02)


def _is_at(lock: IO[bytes], path: Path) -> bool:
    """Return whether an open file is still that at `path`: another process may remove it."""
    try:
        return os.fstat(lock.fileno()).st_ino == path.stat().st_ino
    except FileNotFoundError:
        return False


def _sync(folder: Path) -> None:
    """Flush the entries of a draft and of its subfolders to disk (fsync), not the files."""
    for path in folder.rglob("*"):
        if _is_folder(path):
            sync_folder(path)
    sync_folder(folder)
