# SPDX-License-Identifier: MIT
"""Refuse unknown keys and names, and advise the nearest known one."""

import difflib
from collections.abc import Collection
from pathlib import Path

from zebro_lab.files.errors import SettingsError

_LISTED = 15  # names an error lists before it says how many more there are


def require_known(
    found: Collection[str], known: Collection[str], *, file: Path | None, where: str
) -> None:
    """Refuse keys that mean nothing.

    Args:
        found: Keys of a table.
        known: Keys it may have.
        file: File to name.
        where: The table, with a final dot; "" for the top.

    Raises:
        SettingsError: A key is unknown; names the nearest known one.
    """
    for key in found:
        if key not in known:
            raise SettingsError(
                f"unknown key; {nearest(key, known)}", file=file, key=f"{where}{key}"
            )


def nearest(name: str, known: Collection[str]) -> str:
    """Advise on a name that is not among the known ones.

    >>> nearest("normal_froce", ["normal_force", "t"])
    "did you mean 'normal_force'? known: 'normal_force', 't'"
    """
    folded = {candidate.casefold(): candidate for candidate in known}
    near = difflib.get_close_matches(name.casefold(), folded, n=1, cutoff=0.5)
    listing = ", ".join(f"'{candidate}'" for candidate in list(known)[:_LISTED])
    listing += f" and {len(known) - _LISTED} more" if len(known) > _LISTED else ""
    return (f"did you mean '{folded[near[0]]}'? " if near else "") + f"known: {listing}"
