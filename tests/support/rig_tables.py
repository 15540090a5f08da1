# SPDX-License-Identifier: MIT
"""Small rig tables in canonical columns, and how they are written."""

from pathlib import Path

import numpy as np
import pandas as pd

from model.slip import convert_slip

RADII = '[constants]\nradius_leg = "35 mm"\nradius_ground = 0.12\n'


N = 40


def speeds(n: int = N) -> pd.DataFrame:
    """A rig table in canonical columns."""
    slip = np.linspace(0.0, 0.5, n)
    omega_leg = np.full(n, 12.0)
    return pd.DataFrame({
        "t": np.arange(n) * 0.004,
        "omega_leg": omega_leg,
        "omega_ground": (1 - slip) * omega_leg * 0.035 / 0.12,
        "normal_force": 6.63 + 0.1 * np.sin(np.arange(n)),
        "traction_force": 2.5 * np.tanh(10 * slip),
    })  # fmt: skip


def louder(table: pd.DataFrame, factor: float = 1.01) -> pd.DataFrame:
    """Another recording: the same forces twice would count once."""
    return table.assign(traction_force=factor * table["traction_force"])


def given_slip(definition: str = "travel") -> pd.DataFrame:
    """The same with the slip ratio given."""
    table = speeds()
    slip = convert_slip(np.linspace(0.0, 0.5, N), "material", definition)
    return table.drop(columns=["omega_leg", "omega_ground"]).assign(
        slip_ratio=slip, slip_definition=definition
    )


def write(folder: Path, table: pd.DataFrame, name: str = "rig.csv", **how) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    table.to_csv(folder / name, index=False, **how)
    return folder / name


def columns(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "columns.toml").write_text(text)
    return folder / "columns.toml"
