# SPDX-License-Identifier: MIT
"""Error handling of commands: one line for a known error, a traceback for an unknown one."""

import errno
import os
import sys
from collections.abc import Callable
from typing import Final

from model.errors import ModelError
from rig.errors import RigError, WrongDevice
from zebro_lab.files.errors import SettingsError, ZebroLabError, shortened, shown
from zebro_lab.terminal.stopping import StoppedBySignal
from zebro_lab.terminal.timely_output import leave_at_once, say_in_time

_FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Numbers of the errors of a full or broken disk."""
ERROR: Final = 1
WRONG_USAGE: Final = 2
_PLACES: Final = {
    "legs": "--zebro or sim zebro", "imu": "--imu or sim imu", "slip-rig": "--rig or sim rig",
}  # fmt: skip
"""Where a profile of each kind of device is named on a command line."""


def run(app: Callable[[], object]) -> None:
    """Run a Typer app, which ends with `SystemExit`; known errors are one line and exit code 1.

    Known errors are those of the project, operating system errors that name a file, a full disk or
    memory, and files or folders nested too deep; the line is on stderr. A wrong value of an option
    (a `SettingsError` about one) has exit code 2, as wrong usage has that Typer finds. Other
    exceptions pass unchanged, with a traceback.
    """
    try:
        app()
    except Exception as error:
        _raise_stop_behind(error)
        message = f"{error}{_advice(error)}" if _is_known(error) else _of_the_system(error)
        if message is None:
            raise
        code = WRONG_USAGE if _is_about_option(error) else ERROR
        # At an exit Python would flush again what cannot be printed.
        if not say_in_time(f"error: {shortened(shown(message))}", err=True) or _is_full(error):
            leave_at_once(code)
        raise SystemExit(code) from None


def _raise_stop_behind(error: Exception) -> None:
    """Raise the stop by a signal that a library being imported has turned into its own error."""
    if isinstance(error.__cause__, StoppedBySignal):
        raise error.__cause__ from None


def _advice(error: Exception) -> str:
    """Say where a profile belongs that describes another device; nothing of other errors."""
    place = _PLACES.get(error.found) if isinstance(error, WrongDevice) else None
    return f"; this profile belongs to {place}" if place else ""


def _of_the_system(error: Exception) -> str | None:
    """Format an `OSError` that names a file as "FILE: reason", and what is full or too deep.

    None for other errors.
    """
    # The last words are those of the loader of libraries.
    if isinstance(error, MemoryError) or "failed to map" in f"{error}{error.__context__}":
        return "the memory is full; end other programs, or give less data at once"
    if isinstance(error, RecursionError):
        return "folders, or the content of a file, are nested too deep; expected some 300 levels"
    if _is_full(error):
        return f"the output cannot be written ({error}); free some space"
    if not isinstance(error, OSError) or error.filename is None:
        return None
    name = error.filename if isinstance(error.filename, int) else os.fsdecode(error.filename)
    return f"{name}: {error.strerror or error}"


def _is_full(error: Exception) -> bool:
    """Return whether an output without a name, such as stdout, cannot be written."""
    return isinstance(error, OSError) and error.filename is None and error.errno in _FULL


def _is_about_option(error: Exception) -> bool:
    """Return whether an error is a `SettingsError` about the value of an option."""
    about = isinstance(error, SettingsError) and error.file is None and error.key
    return bool(about) and str(about).startswith("--")


def _is_known(error: Exception) -> bool:
    """Return whether an error is one of the project's own."""
    # Importing the package of photographs here would slow --help down.
    tracking_error = getattr(sys.modules.get("tracking.errors"), "TrackingError", ())
    return isinstance(error, (ZebroLabError, ModelError, RigError, tracking_error))
