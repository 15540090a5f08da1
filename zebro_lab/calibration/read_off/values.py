# SPDX-License-Identifier: MIT
"""Slip curves with the coefficients that were read off them."""

from dataclasses import dataclass

import numpy as np

from model.slip.definition import SlipDefinition
from model.slip.load_curves import LoadCurve
from model.slip.magic_formula import peak_slip
from model.slip.read_off import ReadOff


@dataclass(frozen=True)
class ReadCurve:
    """A curve at one load, and what was read off it.

    Attributes:
        curve: The points, at positive slip and force.
        side: "driving" or "braking".
        found: Coefficients; None where the curve does not give them.
        reason: Why not; empty if it does.
    """

    curve: LoadCurve
    side: str
    found: ReadOff | None
    reason: str = ""

    def row(self) -> dict[str, object]:
        """Return the row of `read-off.csv`; NaN where nothing was found."""
        nan = float("nan")
        found = self.found or ReadOff(nan, nan, nan, nan, (nan,) * 4, nan)
        row: dict[str, object] = {
            "load_n": self.curve.load, "side": self.side, "points": len(self.curve.slip),
        }  # fmt: skip
        for name, error in zip("BCDE", found.errors, strict=True):
            row |= {name: getattr(found, name), f"{name}_error": error}
        peak = float(peak_slip(found.B, found.C, found.E)) if self.found else np.nan
        return row | {
            "peak_over_load": found.D / self.curve.load, "peak_slip": peak,
            "misfit_n": found.misfit, "problem": self.reason,
        }  # fmt: skip


@dataclass(frozen=True)
class ReadOffResult:
    """What was read off all curves.

    Attributes:
        curves: The curves by load, driving before braking.
        definition: Slip definition.
        source: Source of the data.
        notes: Notes on the data, one line each.
    """

    curves: tuple[ReadCurve, ...]
    definition: SlipDefinition
    source: str
    notes: tuple[str, ...]
