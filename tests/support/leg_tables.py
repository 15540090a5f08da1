# SPDX-License-Identifier: MIT
"""Tables of leg angles."""

import numpy as np
import pandas as pd

from zebro_lab.robot.leg_log import ANGLES


def leg_table(n: int = 200, rate: float = 100.0) -> pd.DataFrame:
    """Return angles of six legs that turn steadily, in canonical columns."""
    t = np.arange(n) / rate
    speeds = np.array([3.0, 3.2, 3.0, 3.2, 3.0, 3.2])
    starts = np.array([0.9, 2.3, 2.3, 0.8, 0.9, 2.3])
    return table_of(t, starts + t[:, None] * speeds)


def table_of(t: np.ndarray, theta: np.ndarray) -> pd.DataFrame:
    """Return angles of six legs, shape (n, 6) [rad], at times [s] in canonical columns."""
    return pd.DataFrame({"t": t, **{name: theta[:, i] for i, name in enumerate(ANGLES)}})
