# SPDX-License-Identifier: MIT
"""Replace a folder atomically: a killed process leaves either the old or the new one complete.

| step | on disk | killed after it |
|---|---|---|
| files of others are linked into the draft | NAME old | NAME is old |
| `.NAME.replacing` lists what will be removed | NAME old | NAME is old |
| NAME becomes `NAME.previous` | only the old one | the next reader or writer restores it |
| the draft becomes NAME | both | NAME is new; the next one removes the old |
| what could not be linked is moved, the old one and the note are removed | NAME new | NAME is new |

The note is locked while its writer runs, so that no other process restores during a replacement.
"""

import json
import logging
import os
import shutil
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final

from rig.exclusive import try_lock
from zebro_lab.files.atomic import sync_folder
from zebro_lab.files.errors import AlreadyExists, DataError

PREVIOUS: Final = ".previous"
PATIENCE: Final = 10.0
"""Timeout for another process that replaces the same folder [s]."""
_LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class _Note:
    """Journal entry that a replacement writes before it moves any folder.

    Attributes:
        inode: Inode of the old folder, by which NAME.previous is recognised.
        owned: Files of the old folder that are replaced: paths relative to it, with `/`.
    """

    inode: int
    owned: frozenset[str]


def previous_of(folder: Path) -> Path:
    """Return the path NAME.previous, where the old folder is kept during a replacement."""
    return folder.with_name(folder.name + PREVIOUS)


def replace_folder(folder: Path, draft: Path, *, owned: Callable[[], Collection[str]]) -> None:
    """Replace a folder by a draft, keeping the files that are not owned.

    Args:
        folder: Folder to create or to replace; not a symbolic link.
        draft: The new folder, on the same file system.
        owned: Returns the files of the old folder to remove, as paths relative to it, or raises.
            It is called while the lock is held, so that the list is still valid when it is used.

    Raises:
        AlreadyExists: Another process is replacing it, or NAME.previous is a user's folder.
        OSError: The folder cannot be moved or written; the old one is unchanged.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    with _locked(folder) as note:
        _settle_locked(folder, _read_note(note))
        names = frozenset(owned())
        if folder.exists():
            require_free_previous(folder)
            _carry(folder, draft, names)
            _write_note(note, _Note(folder.stat().st_ino, names))
            _swap(folder, draft)
            _settle_locked(folder, _read_note(note))
        else:
            _sync(draft)
            draft.rename(folder)
            sync_folder(folder.parent)


def settle(path: Path, *, writing: bool = False) -> Path:
    """Restore a result folder after an interrupted replacement that left only NAME.previous.

    Every reader and writer of a result calls it first. If the result is complete, the leftovers of
    the interrupted replacement are removed.

    Args:
        path: Folder of a result, or a file in it.
        writing: Whether NAME is about to be replaced. Then NAME.previous is restored only if a note
            says that a replacement made it; otherwise it may be a user's copy and is kept.

    Returns:
        The path.

    Raises:
        DataError: Only NAME.previous exists and it cannot be renamed.
        AlreadyExists: Another process is still replacing it after `PATIENCE`.
    """
    absolute = Path(os.path.realpath(path))
    for folder in (absolute, absolute.parent):
        if not folder.name or not previous_of(folder).is_dir():
            continue
        if _note_of(folder).exists() or not (writing or folder.exists()):
            _settle(folder, writing=writing)
    return path


def require_free_previous(folder: Path) -> None:
    """Check that NAME.previous is not a user's folder.

    Raises:
        AlreadyExists: It exists; interrupted replacements are settled before this check.
    """
    if os.path.lexists(previous_of(folder)):
        raise AlreadyExists(
            f"{previous_of(folder)} is in the way: the old result is kept under that name while it "
            "is replaced; rename it, or name another --out"
        )


def _settle(folder: Path, *, writing: bool) -> None:
    try:
        with _locked(folder) as note:
            _settle_locked(folder, _read_note(note))
            if not (writing or folder.exists()) and previous_of(folder).is_dir():
                _restore(folder)
    except AlreadyExists:
        raise
    except OSError as error:
        if folder.exists():
            return  # it is complete; an old folder that cannot be removed does not affect readers
        raise DataError(
            f"is missing, and {previous_of(folder).name} beside it cannot be renamed "
            f"({error.strerror}); rename it to {folder.name} by hand",
            file=folder,
        ) from error


def _settle_locked(folder: Path, note: _Note | None) -> None:
    """Finish or undo the replacement of a killed process; other folders are not touched."""
    if note is None or not _is_left(folder, note):
        return
    if not folder.exists():
        _restore(folder)
        return
    _sweep(previous_of(folder), folder, note.owned)
    shutil.rmtree(previous_of(folder), ignore_errors=True)  # else the next one tries again


def _is_left(folder: Path, note: _Note | None) -> bool:
    """Return whether NAME.previous is the folder recorded in a note."""
    previous = previous_of(folder)
    return note is not None and previous.is_dir() and previous.stat().st_ino == note.inode


def _restore(folder: Path) -> None:
    previous_of(folder).rename(folder)
    sync_folder(folder.parent)
    _LOG.warning(
        "%s was restored from %s, which an interrupted replacement had left",
        folder, previous_of(folder).name,
    )  # fmt: skip


def _swap(folder: Path, draft: Path) -> None:
    draft.chmod(folder.stat().st_mode & 0o7777)
    _sync(draft)
    folder.rename(previous_of(folder))
    try:
        draft.rename(folder)
    except OSError:
        previous_of(folder).rename(folder)
        raise
    sync_folder(folder.parent)


def _carry(old: Path, new: Path, owned: Collection[str], prefix: str = "") -> None:
    """Hard-link files that are not owned into the draft; others are moved after the swap."""
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
        _drop_emptied(target, name, owned)


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _link(file: Path, target: Path) -> None:
    try:
        os.link(file, target, follow_symlinks=False)
    except OSError:  # no hard links here, or not to files of others: `_sweep` moves it
        return


def _drop_emptied(folder: Path, name: str, owned: Collection[str]) -> None:
    """Remove a folder whose files were all owned."""
    if any(each.startswith(f"{name}/") for each in owned) and not any(folder.iterdir()):
        folder.rmdir()


def _sweep(old: Path, new: Path, owned: Collection[str], prefix: str = "") -> None:
    """Move files that are not owned and were not linked into the new folder."""
    for path in sorted(old.iterdir()):
        name, target = prefix + path.name, new / path.name
        if name in owned:
            continue
        if _is_folder(path):
            target.mkdir(exist_ok=True)
            _sweep(path, target, owned, f"{name}/")
            _drop_emptied(target, name, owned)
        elif _is_newer(path, target):
            path.replace(target)


def _is_newer(file: Path, target: Path) -> bool:
    """Return whether a file was replaced after its link was made, or could not be linked."""
    if not os.path.lexists(target):
        return True
    one, other = file.lstat(), target.lstat()
    return one.st_ino != other.st_ino and one.st_mtime_ns > other.st_mtime_ns


def _note_of(folder: Path) -> Path:
    return folder.with_name(f".{folder.name}.replacing")


@contextmanager
def _locked(folder: Path) -> Iterator[IO[bytes]]:
    """Lock the note of a folder's replacement; it is removed at the end unless still needed."""
    with _open_locked(folder) as note:
        try:
            yield note
        finally:
            if not _is_left(folder, _read_note(note)):
                _note_of(folder).unlink(missing_ok=True)


def _open_locked(folder: Path) -> IO[bytes]:
    path, deadline = _note_of(folder), time.monotonic() + PATIENCE
    while True:
        note = path.open("a+b")
        if try_lock(note.fileno()) and _is_at(note, path):
            return note
        note.close()
        if time.monotonic() > deadline:
            raise AlreadyExists(
                f"{folder} is being replaced by another process; try again when that has ended"
            )
        time.sleep(0.02)


def _is_at(note: IO[bytes], path: Path) -> bool:
    """Return whether an open note still exists at its path after waiting for its lock."""
    try:
        return os.fstat(note.fileno()).st_ino == path.stat().st_ino
    except FileNotFoundError:
        return False


def _write_note(note: IO[bytes], content: _Note) -> None:
    note.truncate(0)
    note.write(json.dumps({"inode": content.inode, "owned": sorted(content.owned)}).encode())
    note.flush()
    os.fsync(note.fileno())


def _read_note(note: IO[bytes]) -> _Note | None:
    """Read a note; None if it is empty or incomplete."""
    note.seek(0)
    try:
        content = json.loads(note.read())
        return _Note(int(content["inode"]), frozenset(map(str, content["owned"])))
    except (ValueError, TypeError, KeyError):
        return None


def _sync(folder: Path) -> None:
    """Flush every file and folder of a draft to disk (fsync)."""
    for path in folder.rglob("*"):
        if _is_folder(path):
            sync_folder(path)
    sync_folder(folder)
