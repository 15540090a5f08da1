# SPDX-License-Identifier: MIT
"""Runs of one slip become their means; sweeps keep their rows."""

import pytest

from support.plain_samples import TRUTH, fitted_plainly, set_points, sweeps


def test_runs_of_one_slip_are_means_and_share_their_offset():
    found = fitted_plainly(set_points())
    assert found.of_run_means
    assert not found.rows.offset_a_run


def test_sweeps_have_rows_and_an_offset_each():
    found = fitted_plainly(sweeps(a_run=0.5))
    assert len(found.rows) == 1800
    assert found.rows.offset_a_run
    assert found.values[[0, 2]] == pytest.approx(TRUTH[[0, 2]], rel=0.02)


def test_more_rows_than_are_wanted_are_averaged_where_the_curve_is_straight():
    found = fitted_plainly(sweeps(samples=3000))
    assert len(found.rows) < 7000
    assert found.values[0] == pytest.approx(20.0, rel=0.02)
