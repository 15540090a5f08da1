# SPDX-License-Identifier: MIT
"""Lock files (flock) for exclusive use of a device or folder among all programs of a machine.

The kernel releases the lock when its process ends, also after a crash. A device's lock can be taken
several times inside one process, because two drivers may share a bus; the last release frees it.
Windows has no such locks: there only the exclusive opening of serial ports protects a device.
"""

import hashlib
import os
import shlex
import sys
import tempfile
import threading
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from model.file_lock import try_lock
from rig.errors import InUse

LONGEST: Final = 300
"""Longest description of an owner that is stored and shown [characters]."""
_PSEUDO_TERMINALS = "/dev/pts"
"""Folder of the devices of pseudo-terminals."""


@dataclass
class _Held:
    """A lock that this process holds: handle of the open lock file, and number of its holders."""

    handle: int
    count: int = 1


_HELD: Final[dict[str, _Held]] = {}
"""The locks that this process holds, by the path of their file."""
_HELD_GUARD: Final = threading.Lock()


class Exclusive:
    """Lock file of a device or folder, held from `take` to `release`; a context manager.

    Args:
        file: The lock file; created when missing, and never removed.
        what: Name of the device or folder, for the message.
        shared: Whether other `Exclusive` of this process can take the same lock as well.
    """

    def __init__(self, file: Path, *, what: str, shared: bool = False) -> None:
        self._file = Path(os.path.realpath(file))
        self._what = what
        self._shared = shared
        self._taken = False

    def take(self) -> None:
        """Acquire the lock without waiting; a second call, or one on Windows, has no effect.

        Raises:
            InUse: Another process holds the lock, or this one does and the lock is not shared; the
                message describes the process.
            OSError: The file cannot be created or opened.
        """
        if self._taken or os.name != "posix":
            return
        with _HELD_GUARD:
            held = _HELD.get(str(self._file))
            if held is not None and self._shared:
                held.count += 1
            else:  # a process's second handle of a file is refused the lock like another's
                _HELD[str(self._file)] = _Held(self._lock())
        self._taken = True

    def release(self) -> None:
        """Release the lock; has no effect where it is not held.

        One that this process has taken several times becomes free with the last release.
        """
        if not self._taken:
            return
        self._taken = False
        with _HELD_GUARD:
            held = _HELD[str(self._file)]
            held.count -= 1
            if held.count == 0:
                del _HELD[str(self._file)]
                os.close(held.handle)

    def __enter__(self) -> "Exclusive":
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def _lock(self) -> int:
        """Lock the file, describe this process in it, and return its handle, which stays open.

        Raises:
            InUse: Another handle has the lock; the message describes its owner.
            OSError: The file cannot be created or opened.
        """
        handle = _open(self._file)
        if not try_lock(handle):
            owner = _readable(os.pread(handle, 4 * LONGEST, 0))  # UTF-8: up to 4 bytes a character
            os.close(handle)
            raise InUse(
                f"{self._what} is in use by {owner or 'another program'}; end that program first, "
                "or use another device or folder"
            )
        os.ftruncate(handle, 0)
        os.pwrite(handle, _owner().encode("utf-8", "backslashreplace"), 0)
        return handle


def device_lock(name: str) -> Exclusive:
    """Return the lock of a device, not yet taken and shared within this process.

    Args:
        name: A path, followed through links so that all its names are one device, or a name that
            begins with its kind, such as `socketcan:can0` or `udp:192.168.1.1:49152`.
    """
    real = _device_path(name) if name.startswith("/") else name
    return Exclusive(
        _lock_folder() / hashlib.sha256(os.fsencode(real)).hexdigest()[:32], what=name, shared=True
    )


def _device_path(path: str) -> str:
    """Follow the symbolic links of a path to the device, but not the last to a pseudo-terminal.

    The port of a simulated device is a link to a pseudo-terminal. When that is closed, as by
    unplugging the twin, the system may give its number to another program, and a lock on the number
    would then exclude the wrong program. The name of the link belongs to the twin alone.
    """
    real = os.path.realpath(path)
    if not Path(real).is_relative_to(_PSEUDO_TERMINALS):
        return real
    place = Path(path)
    while place.is_symlink():
        target = place.parent / place.readlink()
        if target.is_relative_to(_PSEUDO_TERMINALS):
            break
        place = target
    return str(place.parent.resolve() / place.name)


def _lock_folder() -> Path:
    """Return the folder of device locks, created for all users of the machine where missing."""
    folder = Path(tempfile.gettempdir()) / "zebro-lab-locks"
    try:
        folder.mkdir()
        folder.chmod(0o1777)
    except FileExistsError:
        pass
    return folder


def _open(file: Path) -> int:
    """Open a lock file, without O_CREAT where it exists, and return its handle.

    Linux refuses O_CREAT for another user's file in world-writable folders
    (`fs.protected_regular`).
    """
    flags = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
    try:
        return os.open(file, flags)
    except FileNotFoundError:
        pass
    try:
        handle = os.open(file, flags | os.O_CREAT | os.O_EXCL, 0o666)
    except FileExistsError:  # another program was quicker
        return os.open(file, flags)
    os.fchmod(handle, 0o666)  # whatever the umask: other users lock the same file
    return handle


def _owner() -> str:
    """Describe this process: its id, its command and the time at which it took the lock."""
    command = shlex.join([Path(sys.executable).name, *sys.argv])
    since = datetime.now(UTC).isoformat(timespec="seconds")
    return f"process {os.getpid()} ({command[:LONGEST]}) since {since}"


def _readable(content: bytes) -> str:
    """Decode an owner's description; other than printable characters become `?`, the end is cut."""
    text = content.decode("utf-8", "replace")
    return "".join(character if character.isprintable() else "?" for character in text)[:LONGEST]
