# SPDX-License-Identifier: MIT
"""Watchdogs stop the discs of a program that is killed or held; the twin is another process."""

import numpy as np
import pytest

from benchmarks.faults.stop_faults import ROWS
from benchmarks.faults.stop_latency import StoppedBefore, try_once

pytestmark = pytest.mark.long

WATCHDOG = 0.2
"""Of the twins [s]."""
TRIALS = 20


@pytest.mark.parametrize(
    "row", [row for row in ROWS if row.what in ("SIGKILL", "SIGSTOP")], ids=lambda row: row.name
)
def test_the_discs_rest_soon_after_the_watchdog_has_expired(row):
    rng, trials, before = np.random.default_rng(1), [], []
    while len(trials) < TRIALS:
        try:
            trials.append(try_once(row, rng))
        except StoppedBefore as error:  # the machine held the program up
            before.append(str(error))
            assert len(before) <= TRIALS, before
    assert [trial.problems for trial in trials] == [()] * TRIALS
    assert max(trial.rest for trial in trials) < WATCHDOG + 0.5
