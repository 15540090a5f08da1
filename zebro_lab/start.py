# SPDX-License-Identifier: MIT
"""Entry points of the commands: they can be stopped from here on, and check the packages first.

In an ASCII locale Python starts again in its UTF-8 mode, for no other text of an option or a file's
name could be read there.
"""

import io
import os
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from zebro_lab.terminal.stopping import stoppable

PACKAGES: Final = ("model", "rig", "tracking")


def require_own_packages() -> None:
    """Check that `model`, `rig` and `tracking` are imported from the folder that has `zebro_lab`.

    Their names are common words: a `model.py` in the working folder, or in PYTHONPATH, is found
    before them.

    Raises:
        ImportError: A package is missing, or another file or folder of its name is found first.
    """
    home = Path(__file__).parents[1]
    for package in PACKAGES:
        spec = find_spec(package)
        if spec is None:
            raise ImportError(f"the package '{package}' is missing; reinstall zebro-lab")
        places = [spec.origin or "", *(spec.submodule_search_locations or ())]
        if home / package not in {Path(place) for place in places}:
            found = spec.origin or places[-1]
            raise ImportError(
                f"Python imports {found} instead of the package '{package}' of zebro-lab; rename "
                f"{found}, or start the command in another folder and without it in PYTHONPATH"
            )


def zebro_lab() -> None:
    """Check the packages, then run the command line `zebro-lab`; exit 1 if the check fails."""
    _start("main")


def calibrate_slip() -> None:
    """Check the packages, then run the command line `calibrate-slip`; exit 1 if the check fails."""
    _start("calibrate_slip")


def _start(command: str) -> None:
    """Run a function of `zebro_lab.main`, in any locale, or exit with an error message."""
    if sys.getfilesystemencoding() == "ascii":
        command_line = [sys.executable, "-X", "utf8", *sys.orig_argv[1:]]
        os.execv(sys.executable, command_line)  # noqa: S606 - the same program, the same arguments
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # what the locale cannot write
    with stoppable():
        try:
            require_own_packages()
        except ImportError as error:
            sys.exit(f"error: {error}")
        from zebro_lab import main

        getattr(main, command)()
