# SPDX-License-Identifier: MIT
"""Suggest the known name most similar to an unknown one, for error messages."""

import difflib
from collections.abc import Collection

_LISTED = 15  # names a message lists before it says how many more there are


def nearest(name: str, known: Collection[str]) -> str:
    """Suggest the known name most similar to an unknown one.

    Args:
        name: The unknown name.
        known: All known names.

    Returns:
        Text with the most similar name, if any, upper and lower case alike, and up to 15 of the
        known ones in their order, with the number of the others.

    >>> nearest("normal_froce", ["normal_force", "t"])
    "did you mean 'normal_force'? known: 'normal_force', 't'"
    """
    folded = {candidate.casefold(): candidate for candidate in known}
    near = difflib.get_close_matches(name.casefold(), folded, n=1, cutoff=0.5)
    listing = ", ".join(f"'{candidate}'" for candidate in list(known)[:_LISTED])
    listing += f" and {len(known) - _LISTED} more" if len(known) > _LISTED else ""
    return (f"did you mean '{folded[near[0]]}'? " if near else "") + f"known: {listing}"
