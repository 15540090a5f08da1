# SPDX-License-Identifier: MIT
"""Import ArviZ, which takes seconds, where it is needed and not before."""

from importlib import import_module
from types import ModuleType

ATTEMPTS = 5


def import_arviz() -> ModuleType:
    """Import ArviZ.

    On its first import of a day ArviZ writes a stamp in the user's cache. Of several processes
    that do so at once, all but one may find the file that they rename gone; the stamp then exists.

    Raises:
        ImportError: ArviZ cannot be imported.
        OSError: The user's cache cannot be written.
    """
    for _ in range(ATTEMPTS - 1):
        try:
            return import_module("arviz")
        except FileNotFoundError:
            continue
    return import_module("arviz")
