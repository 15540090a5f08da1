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
    if fcntl is None:
        return True
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def is_locked(handle: int) -> bool | None:
    """Return whether another open handle has a file locked; None where that cannot be told.

    That is so on Windows and on file systems without locks. Others may ask at the same time.

    Args:
        handle: Handle of the file, to be closed after this: it has a shared lock.
    """
    if fcntl is None:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # a file system without locks
        return None
    return False
