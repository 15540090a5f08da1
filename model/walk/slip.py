# SPDX-License-Identifier: MIT
"""Slip law of a walk: a calibrated slip curve, or Coulomb friction."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition, require_definition
from model.walk.path import WalkPath
from model.walk.traction import ToeLaw, TractionTable, VelocityCoulomb, curve_table

if TYPE_CHECKING:
    from model.walk.thesis import Traction


@dataclass(frozen=True)
class Slip:
    """A slip law for walking, with its source.

    Attributes:
        law: A calibrated curve, or Coulomb friction by slip velocity.
        source: Origin of the law: "real", "sim:...", "assumed", "thesis", "unknown".
    """

    law: SlipCurve | VelocityCoulomb
    source: str

    def traction_table(self, *, weight: float, toe: ToeLaw = "saturated") -> TractionTable:
        """Tabulate traction for a robot; slip ratios of any definition are converted.

        Args:
            weight: Weight of the robot [N].
            toe: Traction of a leg on its toe.
        """
        if isinstance(self.law, VelocityCoulomb):
            return self.law.table(weight=weight, toe=toe)
        return curve_table(self.law, weight=weight, toe=toe)

    def thesis_traction(self, *, weight: float) -> "Traction":
        """Prepare the law for the thesis's walking model.

        Args:
            weight: Weight of the robot [N].

        Raises:
            DefinitionMismatch: The curve has another slip definition than the rig's.
        """
        from model.walk.thesis import law_traction, table_traction

        if isinstance(self.law, VelocityCoulomb):
            return table_traction(self.law.table(weight=weight))
        require_definition(self.law.definition, SlipDefinition.MATERIAL)
        return law_traction(self.law.law, self.law.values, weight=weight)

    @property
    def tested_loads(self) -> tuple[float, float] | None:
        """Smallest and largest load tested; None for an assumed law [N]."""
        return None if isinstance(self.law, VelocityCoulomb) else self.law.load_range

    def loads_below_tested(self, path: WalkPath) -> float | None:
        """Compute the share of leg contacts whose load lies below the tested range [-].

        It is None for an assumed law, which has no tested range.
        """
        if self.tested_loads is None:
            return None
        loads = path.normal_force[path.contact]
        return float(np.mean(loads < self.tested_loads[0])) if len(loads) else 0.0
