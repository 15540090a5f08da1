# SPDX-License-Identifier: MIT
"""Replace a folder atomically: a killed process leaves either the old or the new one complete.

| step | on disk | killed after it |
|---|---|---|
| the user's files are linked into the draft | NAME old | NAME is old |
| `.NAME.replacing` lists what will be removed | NAME old | NAME is old |
| NAME becomes `NAME.previous` | only the old one | the next reader or writer restores it |
| the draft becomes NAME | both | NAME is new; the next one removes the old |
| files that were not linked are moved; old one and note are removed | NAME new | NAME is new |

NAME is the folder; *owned* files are those that the command wrote earlier, all other files are the
user's. The note is locked while its writer runs, so that no other process restores meanwhile.
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

from model.file_lock import try_lock
from zebro_lab.files.atomic import sync_folder
from zebro_lab.files.errors import AlreadyExists, DataError
from zebro_lab.files.uninterrupted import uninterrupted

PREVIOUS: Final = ".previous"
PATIENCE: Final = 10.0
"""Timeout for another process that replaces the same folder [s]."""
_LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class _Note:
    """Journal entry that a replacement writes before it moves any folder.

    Attributes:
        inode: Inode of the old folder, by which NAME.previous is recognised.
        owned: Files of the old folder to remove: paths relative to the folder, with `/`.
    """

    inode: int
    owned: frozenset[str]


def previous_of(folder: Path) -> Path:
    """Return the path NAME.previous, where the old folder is kept during a replacement."""
    return folder.with_name(folder.name + PREVIOUS)


def replace_folder(folder: Path, draft: Path, *, owned: Callable[[], Collection[str]]) -> None:
    """Replace a folder by a draft atomically, keeping the user's files: those not in `owned`.

    Args:
        folder: Folder to create or to replace; not a symbolic link.
        draft: The new folder, on the same file system, which is renamed to `folder`.
        owned: Returns the files of the old folder to remove, as paths relative to it, or raises.
            It is called while the lock is held, so that the list is still valid when it is used.

    Raises:
        AlreadyExists: Another process still replaces it after `PATIENCE`, or NAME.previous exists.
        OSError: The folder cannot be moved or written: the old one is unchanged. Or the new one is
            in place, but user's files cannot be moved into it from NAME.previous; the next
            `recover` tries again.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    with _locked(folder) as note:
        _recover_locked(folder, _read_note(note))
        names = frozenset(owned())
        if folder.exists():
            require_free_previous(folder)
            _carry(folder, draft, names)
            with uninterrupted():
                _write_note(note, _Note(folder.stat().st_ino, names))
                _swap(folder, draft)
                _recover_locked(folder, _read_note(note))
        else:
            _sync(draft)
            draft.rename(folder)
            sync_folder(folder.parent)


def recover(path: Path, *, writing: bool = False) -> Path:
    """Restore a result folder after an interrupted replacement that left only NAME.previous.

    Every reader and writer of a result calls this function first. If NAME exists and a note says
    that a replacement left NAME.previous, its user's files are moved to NAME, and it is removed.
    Without a note it is a user's copy, which is kept if NAME exists.

    Args:
        path: Folder of a result, or a file in it.
        writing: Whether NAME is to be replaced; then a user's copy is kept without NAME as well.

    Returns:
        The path, as given.

    Raises:
        DataError: NAME does not exist, and NAME.previous cannot be renamed to it.
        AlreadyExists: Another process still replaces the folder after `PATIENCE`.
    """
    absolute = Path(os.path.realpath(path))
    for folder in (absolute, absolute.parent):
        if not folder.name or not previous_of(folder).is_dir():
            continue
        if _note_of(folder).exists() or not (writing or folder.exists()):
            _recover(folder, writing=writing)
    return path


def require_free_previous(folder: Path) -> None:
    """Check that NAME.previous does not exist; interrupted replacements are settled before.

    Raises:
        AlreadyExists: A file or folder, then a user's, has the name NAME.previous.
    """
    if os.path.lexists(previous_of(folder)):
        raise AlreadyExists(
            f"{previous_of(folder)} exists, but this name is needed for the old result while it is "
            "being replaced; rename it, or choose another folder with --out"
        )


def _recover(folder: Path, *, writing: bool) -> None:
    try:
        with _locked(folder) as note:
            _recover_locked(folder, _read_note(note))
            if not (writing or folder.exists()) and previous_of(folder).is_dir():
                _restore(folder)
    except AlreadyExists:
        raise
    except OSError as error:
        if folder.exists():
            return  # it is complete; an old folder that cannot be removed does not affect readers
        raise DataError(
            f"is missing: a replacement was interrupted, and {previous_of(folder).name} cannot be "
            f"renamed back ({error.strerror}); rename it to {folder.name} by hand",
            file=folder,
        ) from error


def _recover_locked(folder: Path, note: _Note | None) -> None:
    """Finish the replacement that a note records, or undo it if NAME is missing.

    Without a note, or if NAME.previous is another folder than in the note, nothing is done.
    """
    if note is None or not _is_left(folder, note):
        return
    if not folder.exists():
        _restore(folder)
        return
    _sweep(previous_of(folder), folder, note.owned)
    shutil.rmtree(previous_of(folder), ignore_errors=True)  # else the next one tries again


def _is_left(folder: Path, note: _Note | None) -> bool:
    """Return whether NAME.previous exists and has the inode in a note; False without a note."""
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
    """Hard-link the user's files, names not in `owned`, from the old folder into the new one.

    Files that cannot be linked are moved by `_sweep` after the swap; owned files are left behind.
    A file that the new folder has already stays as it is there. `prefix` is the path of `old`
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
        _drop_emptied(target, name, owned)


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _link(file: Path, target: Path) -> None:
    try:
        os.link(file, target, follow_symlinks=False)
    except OSError:  # the file system or the file's owner forbids hard links: `_sweep` moves it
        return


def _drop_emptied(folder: Path, name: str, owned: Collection[str]) -> None:
    """Remove a folder if it is empty and `owned` lists a file below `name`, its relative path."""
    if any(each.startswith(f"{name}/") for each in owned) and not any(folder.iterdir()):
        folder.rmdir()


def _sweep(old: Path, new: Path, owned: Collection[str], prefix: str = "") -> None:
    """Move the user's files that `new` lacks, or has in an older version, from `old` to `new`.

    The user's are those not in `owned`; `prefix` as in `_carry`.
    """
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
    """Return whether `target` is missing, or is another file (inode) modified before `file`."""
    if not os.path.lexists(target):
        return True
    one, other = file.lstat(), target.lstat()
    return one.st_ino != other.st_ino and one.st_mtime_ns > other.st_mtime_ns


def _note_of(folder: Path) -> Path:
    return folder.with_name(f".{folder.name}.replacing")


@contextmanager
def _locked(folder: Path) -> Iterator[IO[bytes]]:
    """Open and lock a folder's note; remove it at the end unless NAME.previous, as noted, is left.

    Raises:
        AlreadyExists: Another process still holds the lock after `PATIENCE`.
        OSError: The note cannot be opened or read.
    """
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
                f"{folder} is being replaced by another process; try again when that process ends"
            )
        time.sleep(0.02)


def _is_at(note: IO[bytes], path: Path) -> bool:
    """Return whether an open note is still the file at `path`: another process may remove it."""
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
    """Parse the content of an open note; None if it is empty or incomplete."""
    note.seek(0)
    try:
        content = json.loads(note.read())
        return _Note(int(content["inode"]), frozenset(map(str, content["owned"])))
    except (ValueError, TypeError, KeyError):
        return None


def _sync(folder: Path) -> None:
    """Flush the entries of a draft and of its subfolders to disk (fsync), not the files."""
    for path in folder.rglob("*"):
        if _is_folder(path):
            sync_folder(path)
    sync_folder(folder)
