# SPDX-License-Identifier: MIT
"""Slip law of a walk: a calibrated slip curve, or Coulomb friction."""

from dataclasses import dataclass

import numpy as np

from model.slip.curve import SlipCurve
from model.walk.path import WalkPath
from model.walk.traction import TractionTable, VelocityCoulomb, curve_table


@dataclass(frozen=True)
class Slip:
    """A slip law for walking, with its source.

    Attributes:
        law: A slip law with values from a calibration or the thesis, or Coulomb friction by slip
            velocity.
        source: Where the law's data come from: "assumed" for Coulomb friction, "thesis", or the
            source of the calibration's data, "real", "sim:..." or others of `docs/conventions.md`.
    """

    law: SlipCurve | VelocityCoulomb
    source: str

    def traction_table(self, *, weight: float) -> TractionTable:
        """Tabulate traction over load for the compiled loop, by `curve_table` or Coulomb friction.

        Args:
            weight: Weight of the robot [N].

        Raises:
            DomainError: The curve loses its law's shape at these loads.
        """
        if isinstance(self.law, VelocityCoulomb):
            return self.law.table(weight=weight)
        return curve_table(self.law, weight=weight)

    @property
    def tested_loads(self) -> tuple[float, float] | None:
        """Smallest and largest load of the curve's measurements [N]; None for `VelocityCoulomb`."""
        return None if isinstance(self.law, VelocityCoulomb) else self.law.load_range

    def loads_below_tested(self, path: WalkPath) -> float | None:
        """Compute the share of a path's leg contacts with less load than the smallest tested [-].

        A contact is one leg at one sample; 0 without contacts or without forces (NaN), None for
        Coulomb friction by slip velocity.
        """
        if self.tested_loads is None:
            return None
        loads = path.normal_force[path.contact]
        return float(np.mean(loads < self.tested_loads[0])) if len(loads) else 0.0
