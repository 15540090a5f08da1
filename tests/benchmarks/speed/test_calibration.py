# SPDX-License-Identifier: MIT
from importlib.util import find_spec

import pytest

from benchmarks.speed import calibration
from rig.slip_rig.sweep import SweepPlan

SMALL = SweepPlan(slips=(0.02, 0.05, 0.1, 0.2, 0.4, 0.8), duration=0.4)


@pytest.mark.long
def test_a_small_sweep_has_a_row_for_each_likelihood_engine_and_reader(monkeypatch, rows):
    few = {"KEPT_STEPS": 10, "IMPORTANCE_DRAWS": 500, "NAIVE_SECONDS": 0.05, "READS": 1}
    for name, value in few.items():
        monkeypatch.setattr(calibration, name, value)
    monkeypatch.setattr(calibration.rate, "__kwdefaults__", {"seconds": 0.05})
    calibration.main(SMALL, SMALL)
    table = rows()
    peer = find_spec("numpyro") is not None
    assert len(table) == 5 + (6 + peer) + (3 + 2 * peer) + 2
    assert table[0][3] == "1.00"  # of ours
    engines, ratios = table[5 : 11 + peer], table[11 + peer : -2]
    rates = [row[2] for row in (*table[:5], *table[-2:])] + [row[3] for row in engines]
    assert all(float(rate.replace(",", "")) > 0 for rate in rates)
    assert all(float(row[1].replace(",", "")) >= 0 for row in ratios)
    assert float(table[-2][1]) <= float(table[-1][1])  # pandas alone does less
