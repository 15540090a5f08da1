# SPDX-License-Identifier: MIT
"""Tables of slip curves."""

from pathlib import Path

import numpy as np
import pandas as pd

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

THESIS_LOADS = (2.13, 6.63, 8.13, 12.75)
"""Loads of Fig. 4-14 [N]."""


def thesis_table(loads: tuple[float, ...] = THESIS_LOADS, *, points: int = 62) -> pd.DataFrame:
    """The thesis's curve at its grid of slip ratios, in canonical columns."""
    slip, load = np.tile(np.linspace(0, 1, points), len(loads)), np.repeat(loads, points)
    force = THESIS_LAW.force(slip, load, THESIS_VALUES)
    return pd.DataFrame({
        "slip_ratio": slip, "slip_definition": "material", "normal_force": load,
        "traction_force": force,
    })  # fmt: skip


def written_curve(path: Path, table: pd.DataFrame) -> Path:
    """Write a table of a curve."""
    path.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(path, index=False)
    return path
