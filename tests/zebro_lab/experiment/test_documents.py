# SPDX-License-Identifier: MIT
"""Results of the rig's commands in numbers; whole documents are in test_json_documents.py."""

from pathlib import Path

from rig.experiment.run import Outcome
from zebro_lab.experiment.documents import experiment_in_numbers
from zebro_lab.experiment.journal import Journal


def test_a_run_that_was_cut_short_has_its_reason_and_no_numbers():
    entry = {"text": "safe stop: SIGTERM", "number": 3, "accepted": False, "attempt": 1,
             "folder": "a"}  # fmt: skip
    journal = Journal("hash", {}, frozenset({"a"}), None, [entry])
    outcome = Outcome("safe stop: SIGTERM", 2, (), 1, "real")
    found = experiment_in_numbers(outcome, journal, Path("data"))
    assert not found["simulated"]
    assert found["runs"] == [{
        "name": "a", "point": 3, "attempt": 1, "accepted": False, "why": "safe stop: SIGTERM",
        "slip_ratio": None, "friction": None, "normal_force_N": None,
    }]  # fmt: skip
