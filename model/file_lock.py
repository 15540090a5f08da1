# SPDX-License-Identifier: MIT
"""Lock an open file against other programs of the machine (flock)."""

import importlib
import os
from typing import Any

fcntl: Any = importlib.import_module("fcntl") if os.name == "posix" else None


def try_lock(handle: int) -> bool:
    """Lock an open file, given by its handle, without waiting; return whether it is now locked.

    False where another open handle has the lock. Also True, without a lock, where the system
    (Windows) or the file system has none. Closing the file, or the end of the process, releases it.
    """
    return _lock(handle, shared=False) is not False


def is_locked(handle: int) -> bool | None:
    """Return whether another open handle has a file locked; None where that cannot be told.

    That is so on Windows and on file systems without locks. Others may ask at the same time.

    Args:
        handle: Handle of the file, to be closed after this: it has a shared lock.
    """
    locked = _lock(handle, shared=True)
    return None if locked is None else not locked


def _lock(handle: int, *, shared: bool) -> bool | None:
    """Lock an open file without waiting; return whether that succeeded, None without locks."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return None
    return True
