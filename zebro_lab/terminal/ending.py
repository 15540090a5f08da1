# SPDX-License-Identifier: MIT
"""How a command ends: one line for a known error, a traceback for an unknown one."""

import sys
import warnings
from collections.abc import Callable

import typer


def run(app: typer.Typer) -> None:
    """Run a Typer app; known errors become one line on stderr and exit code 1."""
    # ArviZ tells developers of its next version once a day; users can do nothing about it.
    warnings.filterwarnings("ignore", message=r"\s*ArviZ is undergoing", category=FutureWarning)
    _guard(lambda: app())


def _guard(command: Callable[[], object]) -> None:
    try:
        command()
    except Exception as error:
        if not _is_known(error):
            raise
        from zebro_lab.files.shown_text import shortened, shown
        from zebro_lab.terminal.last_words import leave_at_once, say_in_time

        if not say_in_time(f"error: {shortened(shown(str(error)))}", err=True):
            leave_at_once(1)
        raise SystemExit(1) from None


def _is_known(error: Exception) -> bool:
    # The roots are looked up among what is loaded: importing them here would slow --help down.
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
