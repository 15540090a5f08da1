# SPDX-License-Identifier: MIT
"""Entry points of the commands: they can be stopped from here on, and check the packages first."""

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
    with stoppable():
        _check_or_exit()
        from zebro_lab.main import main

        main()


def calibrate_slip() -> None:
    """Check the packages, then run the command line `calibrate-slip`; exit 1 if the check fails."""
    with stoppable():
        _check_or_exit()
        from zebro_lab.main import calibrate_slip

        calibrate_slip()


def _check_or_exit() -> None:
    """Exit with an error message unless the packages are zebro-lab's own."""
    try:
        require_own_packages()
    except ImportError as error:
        sys.exit(f"error: {error}")
