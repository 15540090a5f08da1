# SPDX-License-Identifier: MIT
from importlib.util import find_spec

from benchmarks.speed import calibration
from rig.slip_rig.sweep import SweepPlan

SMALL = SweepPlan(slips=(0.02, 0.05, 0.1, 0.2, 0.4, 0.8), duration=0.4)


def test_a_small_sweep_has_a_row_for_each_likelihood_engine_and_reader(monkeypatch, rows):
    for name, few in (("KEPT_STEPS", 10), ("IMPORTANCE_DRAWS", 500), ("READS", 1)):
        monkeypatch.setattr(calibration, name, few)
    monkeypatch.setattr(calibration.rate, "__kwdefaults__", {"seconds": 0.05})
    calibration.main(SMALL, SMALL)
    table = rows()
    assert len(table) == 4 + 4 + (find_spec("numpyro") is not None) + 2
    assert table[0][3] == "1.00"  # of ours
    rates = [
        row[3] if row[0].startswith(("emcee", "NumPyro", "Laplace")) else row[2] for row in table
    ]
    assert all(float(rate.replace(",", "")) > 0 for rate in rates)
    assert float(table[-2][1]) <= float(table[-1][1])  # pandas alone does less
