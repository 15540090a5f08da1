# SPDX-License-Identifier: MIT
"""Samples known in SI become a run of raw samples whose profile leaves them as they are."""

from datetime import UTC, datetime

import numpy as np
import pytest

from support.table_runs import slip_rig_run
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.slip_rig_table import SlipRigTable


def write(folder, table):
    return slip_rig_run(
        folder, table, label="a", material="", operator="", source="real",
        start=datetime(2026, 1, 1, tzinfo=UTC), radius_leg=0.03, radius_ground=0.1,
    )  # fmt: skip


@pytest.mark.parametrize("n", [1, 2, 999, 1001])
def test_every_bit_comes_back(tmp_path, n):
    rng = np.random.default_rng(n)
    table = SlipRigTable(np.cumsum(rng.random(n)), *rng.normal(size=(4, n)))
    folder = write(tmp_path, table)
    np.testing.assert_array_equal(read_slip_rig_run(folder).table.rows(), table.rows())
    stream = read_raw_log(folder / "log.mcap").streams["/board/raw"]
    np.testing.assert_array_equal(stream.counts[:, 0], table.normal_force)
