# SPDX-License-Identifier: MIT
"""A small simulated sweep on disk, for the tests of the calibrate stage and its command."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SOURCE_LAW, SOURCE_VALUES, SweepPlan, simulate_sweep

COLUMNS = """
source = "sim:rig-sweep"
runs.by = ["run"]
load_cell.zero_stability = "0.1 N"
"""


@pytest.fixture(scope="session")
def sweep(tmp_path_factory) -> Path:
    """Return a folder with one CSV of 24 runs, 3,600 samples, and its columns.toml.

    The truth behind it is `SOURCE_VALUES` of `SOURCE_LAW`.
    """
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.9, 12) ** 1.5), loads=(4.0, 12.0), rate=150.0)
    rng = np.random.default_rng(1)
    simulated = simulate_sweep(
        SOURCE_LAW, SOURCE_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    )
    folder = tmp_path_factory.mktemp("sweep")
    table = pd.DataFrame(simulated.table).assign(
        radius_leg=plan.radius_leg, radius_ground=plan.radius_ground
    )
    table.to_csv(folder / "sweep.csv", index=False)
    (folder / "columns.toml").write_text(COLUMNS)
    return folder
