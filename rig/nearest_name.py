# SPDX-License-Identifier: MIT
"""Suggest the known name most similar to an unknown one, for error messages."""

from collections.abc import Collection

from model.similar_name import similar_name

_LISTED = 15  # names a message lists before it says how many more there are


def nearest(name: str, known: Collection[str]) -> str:
    """Suggest the known name most similar to an unknown one.

    Args:
        name: The unknown name.
        known: All known names.

    Returns:
        Text with the name that was likely meant, if any (`similar_name`), and up to 15 of the known
        ones in their order, with the number of the others.

    >>> nearest("normal_froce", ["normal_force", "t"])
    "did you mean 'normal_force'? known: 'normal_force', 't'"
    """
    near = similar_name(name, known)
    listing = ", ".join(f"'{candidate}'" for candidate in list(known)[:_LISTED])
    listing += f" and {len(known) - _LISTED} more" if len(known) > _LISTED else ""
    return (f"did you mean '{near}'? " if near else "") + f"known: {listing}"
