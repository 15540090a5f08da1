# SPDX-License-Identifier: MIT
"""A track by a wrong clock is named, where the robot stands before and after its walk."""

import pytest

from benchmarks.accuracy.planted_clock_faults import Job, judged

pytestmark = pytest.mark.reference


@pytest.mark.parametrize("behind", [1.0, 2.0])
def test_a_clock_that_is_behind_is_named(behind):
    said = judged(Job(behind, True, 5))
    assert said.wrong
    assert not said.not_testable


def test_a_right_clock_draws_no_remark():
    said = judged(Job(0.0, True, 5))
    assert not said.wrong
    assert not said.not_testable


def test_a_walk_without_a_stand_is_not_judged_wrong():
    assert not judged(Job(0.0, False, 5)).wrong
