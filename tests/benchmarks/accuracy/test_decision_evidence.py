# SPDX-License-Identifier: MIT
import re

from benchmarks.accuracy import decision_evidence


def test_expected_and_measured_traction_are_scored(capsys):
    decision_evidence.crosstalk(1)
    lines = capsys.readouterr().out.splitlines()
    assert [line[:17] for line in lines] == ["expected traction", "measured traction"]
    scores = [float(re.search(r"mean ([+-]\d+\.\d+)", line)[1]) for line in lines]
    assert all(abs(score) < 6 for score in scores)
