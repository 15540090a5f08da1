# SPDX-License-Identifier: MIT
import re
from functools import partial

from benchmarks.accuracy import decision_evidence
from rig.slip_rig.sweep import SweepPlan

FEW_SLIPS = (0.0, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.35, 0.6, 0.9)


def test_expected_and_measured_traction_are_scored(capsys, monkeypatch):
    monkeypatch.setattr(decision_evidence, "SweepPlan", partial(SweepPlan, slips=FEW_SLIPS))
    decision_evidence.crosstalk(1)
    lines = capsys.readouterr().out.splitlines()
    assert [line[:17] for line in lines] == ["expected traction", "measured traction"]
    scores = [float(re.search(r"mean ([+-]\d+\.\d+)", line)[1]) for line in lines]
    assert all(abs(score) < 6 for score in scores)
