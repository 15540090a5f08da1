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
        row: dict[str, object] = {
            "load_n": self.curve.load, "side": self.side, "points": len(self.curve.slip),
        }  # fmt: skip
        values = [np.nan] * 4 if self.found is None else list(_coefficients(self.found))
        errors = [np.nan] * 4 if self.found is None or self.found.errors is None else list(
            self.found.errors
        )  # fmt: skip
        for name, value, error in zip("BCDE", values, errors, strict=True):
            row |= {name: value, f"{name}_error": error}
        B, C, _, E = values
        return row | {
            "peak_over_load": values[2] / self.curve.load,
            "peak_slip": float(peak_slip(B, C, E)) if self.found else np.nan,
            "misfit_n": self.found.misfit if self.found else np.nan,
            "method": self.found.method if self.found else "",
            "problem": self.reason,
        }


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


def _coefficients(found: ReadOff) -> tuple[float, float, float, float]:
    return found.B, found.C, found.D, found.E
