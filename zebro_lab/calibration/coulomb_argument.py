# SPDX-License-Identifier: MIT
"""Parse `coulomb:MU[:V]`, the Coulomb friction of an option `--slip`."""

import math
from typing import Final

from zebro_lab.files.errors import SettingsError

COULOMB: Final = "coulomb"
MOST_FRICTION: Final = 2.0
"""Largest coefficient of friction that is believed [-]; rubber on dry rock has about 1.2."""


def coulomb_numbers(text: str) -> tuple[float, ...] | None:
    """Return MU [-], and V [m/s] if given, of `coulomb:MU[:V]`; None for another text.

    Raises:
        SettingsError: A number is missing, not finite or not above 0, there are too many, or MU is
            larger than `MOST_FRICTION`.

    >>> coulomb_numbers("coulomb:0.38:0.001"), coulomb_numbers("thesis")
    ((0.38, 0.001), None)
    """
    name, *parts = text.split(":")
    if name != COULOMB:
        return None
    expected = "coulomb:MU[:V], such as coulomb:0.38 or coulomb:0.38:0.001 (V in m/s)"
    try:
        numbers = tuple(float(part) for part in parts)
    except ValueError as error:
        raise SettingsError(
            f"'{text}' has a part that is no number; expected {expected}", key="--slip"
        ) from error
    if not 1 <= len(numbers) <= 2 or not all(0 < each < math.inf for each in numbers):
        raise SettingsError(
            f"'{text}' is no friction law; expected {expected}, finite, above 0", key="--slip"
        )
    if numbers[0] > MOST_FRICTION:
        raise SettingsError(
            f"'{text}': a friction of {numbers[0]:g} is improbable, expected at most "
            f"{MOST_FRICTION:g}{_meant(numbers[0])}",
            key="--slip",
        )
    return numbers


def _meant(friction: float) -> str:
    """Return "; did you mean …?" for a friction from 10 to 100, as if in percent; else ""."""
    return f"; did you mean {COULOMB}:{friction / 100:g}?" if 10 <= friction <= 100 else ""
