# SPDX-License-Identifier: MIT
"""Table of the slip laws: name and class. It imports nothing, so that options can name the laws."""

from typing import Final

SLIP_LAWS: Final = {
    "magic-formula": "model.slip.magic_formula.MagicFormula",
    "brush": "model.slip.brush.Brush",
    "coulomb-stribeck": "model.slip.coulomb.CoulombStribeck",
}
"""Class of every slip law by the law's name: `--law`, `slip.toml` and the contract find it here."""
