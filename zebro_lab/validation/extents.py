# SPDX-License-Identifier: MIT
"""Notice by the extents of two paths that their lengths are in different units."""

from typing import Final

import numpy as np

from model.arrays import Array

_UNITS: Final = {
    1000.0: "mm and m", 100.0: "cm and m", 10.0: "mm and cm", 25.4: "mm and inches",
    39.37: "inches and m", 3.281: "feet and m", 57.296: "degrees and radians",
}  # fmt: skip
"""Units of which one number is larger than the other, by the factor between them."""
_LARGE: Final = 20.0
"""Factor from which on only different units explain the ratio, not a walk's wrong friction [-]."""
_CLOSE: Final = 0.05
"""Largest relative difference of a ratio from a factor below `_LARGE` [-]."""


def unit_warning(
    reference: tuple[Array, str], estimate: tuple[Array, str], *, near: float
) -> tuple[str, ...]:
    """Return a question if the extents of two paths differ by about the factor between two units.

    An extent is the rms distance of the positions from their mean. No question, an empty tuple, is
    returned if the ratio fits no pair of units or a path stays in one place.

    Args:
        reference: Positions, shape (n, d) [m], and their name for the warning.
        estimate: The same for the other path, at the same times.
        near: Largest relative difference of the ratio of extents from a factor of `_LARGE` or more.
            For smaller factors the limit is `_CLOSE`, or `near` if that is less [-].
    """
    spread = [float(np.linalg.norm(path.std(axis=0))) for path, _ in (reference, estimate)]
    if min(spread) <= 0:
        return ()
    ratio = spread[1] / spread[0]
    factor = max(ratio, 1 / ratio)
    units = [
        pair
        for known, pair in _UNITS.items()
        if abs(factor / known - 1) < (near if known >= _LARGE else min(near, _CLOSE))
    ]
    if not units:
        return ()
    large, small = (estimate[1], reference[1]) if ratio > 1 else (reference[1], estimate[1])
    return (
        f"WARNING: {large} extends {factor:.4g} times as far as {small}, about as {units[0]} "
        "differ: is one in another unit? Lengths are taken in m; if so, convert it",
    )
