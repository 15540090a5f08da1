# SPDX-License-Identifier: MIT
"""Samples of the slip rig: rows are selected in all columns that were measured."""

import numpy as np

from support.written_runs import make_table


def test_selected_rows_hold_all_that_was_measured():
    table = make_table(5)
    chosen = table.select(np.array([True, False, True, False, False]))
    assert set(chosen.measured()) == set(table.measured())
    np.testing.assert_array_equal(chosen.rows(), table.rows()[[0, 2]])
