# SPDX-License-Identifier: MIT
"""The slip curve of the thesis: Eq. (4-45) and Listings A.20 and A.21."""

from typing import Final

import numpy as np

from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.magic_formula import MagicFormula

THESIS_LAW: Final = MagicFormula(curvature="peak")
THESIS_VALUES: Final[tuple[float, ...]] = (34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066)
"""Values of `THESIS_LAW`: B and C of Eq. (4-45); D = 0.3798·Fn and x_m = 0.0066·Fn, Listing A.20.

K = B·C·mu [-], C [-], mu [-], x_m/Fn [1/N].
"""
_LOADS = (2.13, 12.75)  # Fig. 4-14 [N]


def thesis_curve() -> SlipCurve:
    """Return the thesis's slip curve: `THESIS_LAW` with `THESIS_VALUES` and covariance zero.

    It is of material slip, for loads of 2.13 to 12.75 N and slip ratios of 0 to 1.
    """
    k = len(THESIS_VALUES)
    return SlipCurve(
        law=THESIS_LAW,
        values=np.array(THESIS_VALUES),
        covariance=np.zeros((k, k)),
        definition=SlipDefinition.MATERIAL,
        load_range=_LOADS,
        slip_range=(0.0, 1.0),
    )
