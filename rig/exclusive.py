# SPDX-License-Identifier: MIT
"""Locks for exclusive use of a device or folder among all programs of a machine.

The kernel keeps a lock, and releases it when its process ends, also after a crash. On Linux the
lock is an abstract Unix socket with a name made of the device's: no file that may be deleted, one
for all users, temporary folders and mount namespaces; only another network namespace has its own.
Elsewhere it is a file at a fixed place. A folder is also locked itself (flock), in every namespace.

A device's lock can be taken several times inside one process, because two drivers may share a bus;
the last release frees it. Windows has no such locks: there only the exclusive opening of serial
ports protects a device.
"""

import contextlib
import errno
import hashlib
import os
import re
import shlex
import socket
import struct
import sys
import threading
from pathlib import Path
from typing import Final

from model.file_lock import try_lock
from rig.errors import InUse

LONGEST: Final = 300
"""Longest command of an owner that is shown [characters]."""
_NAMED: Final = sys.platform == "linux"
"""Whether the system has abstract Unix sockets."""
_LOCK_FILES: Final = Path("/tmp")  # noqa: S108 - one place for all programs, whatever TMPDIR is
"""Folder of the lock files of devices where there are no abstract sockets."""
_PSEUDO_TERMINALS = "/dev/pts"
"""Folder of the devices of pseudo-terminals."""
_HOST: Final = re.compile(r"(?<=^udp:)[A-Za-z][^:/?]*|(?<=^socket://)[A-Za-z][^:/?]*")
"""Name of the host of a device on the network; an address does not match."""
_MOST_ASKING: Final = 4096
"""Number of programs that may ask for the owner of a lock, which answers none of them."""


class _Held(contextlib.ExitStack):
    """A lock that this process holds until this is closed, and the number of its holders."""

    count = 1


_HELD: Final[dict[str, _Held]] = {}
"""The locks that this process holds, by name."""
_HELD_GUARD: Final = threading.Lock()


class Exclusive:
    """Lock of a device or folder, held from `take` to `release`; a context manager.

    Args:
        name: Name of the lock, the same in all programs.
        what: Name of the device or folder, for the message.
        file: Folder or file that is locked as well; created as a file when missing, never written.
        shared: Whether other `Exclusive` of this process can take the same lock as well.
    """

    def __init__(
        self, name: str, *, what: str, file: Path | None = None, shared: bool = False
    ) -> None:
        self._name = name
        self._what = what
        self._file = file
        self._shared = shared
        self._taken = False

    def take(self) -> None:
        """Acquire the lock without waiting; a second call, or one on Windows, has no effect.

        Raises:
            InUse: Another process holds the lock, or this one does and the lock is not shared; on
                Linux the message names the process and its command.
            OSError: The socket or file cannot be created or opened.
        """
        if self._taken or os.name != "posix":
            return
        with _HELD_GUARD:
            held = _HELD.get(self._name)
            if held is not None and self._shared:
                held.count += 1
            else:  # a process's second lock of a name is refused like another's
                _HELD[self._name] = self._lock()
        self._taken = True

    def release(self) -> None:
        """Release the lock; has no effect where it is not held.

        One that this process has taken several times becomes free with the last release.
        """
        if not self._taken:
            return
        self._taken = False
        with _HELD_GUARD:
            held = _HELD[self._name]
            held.count -= 1
            if held.count == 0:
                del _HELD[self._name]
                held.close()

    def __enter__(self) -> "Exclusive":
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def _lock(self) -> _Held:
        """Acquire the lock and return what holds it until it is closed; raises as `take`."""
        with _Held() as held:
            if _NAMED:
                held.enter_context(self._listen())
            if self._file is not None:
                # Opened for reading only: what is there, also under another name, is not changed.
                create = 0 if self._file.is_dir() else os.O_CREAT
                flags = os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW | create
                handle = os.open(self._file, flags, 0o666)
                held.callback(os.close, handle)
                if not try_lock(handle):
                    raise self._in_use("another program")
            return held.pop_all()

    def _listen(self) -> socket.socket:
        """Listen at the abstract socket with the lock's name; raise InUse where another does."""
        opened, place = socket.socket(socket.AF_UNIX), f"\0zebro-lab/{_hash(self._name)}"
        try:
            opened.bind(place)
            opened.listen(_MOST_ASKING)
        except OSError as error:
            opened.close()
            if error.errno != errno.EADDRINUSE:
                raise
            raise self._in_use(_owner(place)) from None
        return opened

    def _in_use(self, owner: str) -> InUse:
        """Return the error that another program has the lock."""
        return InUse(
            f"{self._what} is in use by {owner}; end that program first, or use another device or "
            "folder"
        )


def device_lock(name: str) -> Exclusive:
    """Return the lock of a device, not yet taken and shared within this process.

    Args:
        name: A path, followed through links so that all its names are one device, or a name that
            begins with its kind, such as `socketcan:can0` or `udp:192.168.1.1:49152`; the names of
            a host, as in `socket://localhost:4000`, are one device, too.
    """
    real = _device_path(name) if name.startswith("/") else _HOST.sub(_address, name)
    file = None if _NAMED else _LOCK_FILES / f"zebro-lab-{_hash(real)}.lock"
    return Exclusive(real, what=name, file=file, shared=True)


def folder_lock(folder: Path, *, what: str) -> Exclusive:
    """Return the lock of an existing folder, not yet taken; nothing is written into the folder.

    Args:
        folder: The folder, by any of its names.
        what: What it is, for the message.

    Raises:
        OSError: There is no such folder.
    """
    found = folder.stat()
    return Exclusive(f"folder:{found.st_dev}:{found.st_ino}", what=what, file=folder.resolve())


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


def _address(host: re.Match[str]) -> str:
    """Return the address of a host that `_HOST` has found; its name where that is unknown."""
    with contextlib.suppress(OSError, UnicodeError):
        return socket.gethostbyname(host[0])
    return host[0]


def _hash(name: str) -> str:
    """Return the hash of a lock's name, by which all programs find it."""
    return hashlib.sha256(os.fsencode(name)).hexdigest()[:32]


def _owner(place: str) -> str:
    """Describe the process that listens at an abstract socket, by its id and command.

    `another program` where the system does not tell, as of another container.
    """
    with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX) as asking:
        asking.setblocking(False)  # an owner that was asked too often does not answer
        asking.connect(place)
        credentials = asking.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
        process = struct.unpack("i", credentials[:4])[0]
        words = Path(f"/proc/{process}/cmdline").read_bytes().decode("utf-8", "replace")
        command = shlex.join(words.rstrip("\0").split("\0"))[:LONGEST]
        return f"process {process} ({''.join(c if c.isprintable() else '?' for c in command)})"
    return "another program"
