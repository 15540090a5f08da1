# SPDX-License-Identifier: MIT
"""Error handling of commands: one line for a known error, a traceback for an unknown one."""

import os
import sys
import warnings
from collections.abc import Callable

import typer


def run(app: typer.Typer) -> None:
    """Run a Typer app, which ends with `SystemExit`; known errors are one line and exit code 1.

    Known errors are those of the project, and operating system errors that name a file; the line is
    on stderr. Other exceptions pass unchanged, with a traceback.
    """
    # ArviZ warns developers about its next version once a day; this does not concern users.
    warnings.filterwarnings("ignore", message=r"\s*ArviZ is undergoing", category=FutureWarning)
    _guard(lambda: app())


def _guard(command: Callable[[], object]) -> None:
    try:
        command()
    except Exception as error:
        message = str(error) if _is_known(error) else _of_a_file(error)
        if message is None:
            raise
        from zebro_lab.files.shown_text import shortened, shown
        from zebro_lab.terminal.last_words import leave_at_once, say_in_time

        if not say_in_time(f"error: {shortened(shown(message))}", err=True):
            leave_at_once(1)
        raise SystemExit(1) from None


def _of_a_file(error: Exception) -> str | None:
    """Format an `OSError` that names a file as "FILE: reason"; return None for other errors."""
    if not isinstance(error, OSError) or error.filename is None:
        return None
    name = error.filename if isinstance(error.filename, int) else os.fsdecode(error.filename)
    return f"{name}: {error.strerror or error}"


def _is_known(error: Exception) -> bool:
    # The root errors are looked up in loaded modules: importing them here would slow --help down.
    roots = [
        getattr(sys.modules.get(module), name, None)
        for module, name in (
            ("zebro_lab.files.errors", "ZebroLabError"),
            ("model.errors", "ModelError"),
            ("rig.errors", "RigError"),
            ("tracking.errors", "TrackingError"),
        )
    ]
    return any(root is not None and isinstance(error, root) for root in roots)
