# SPDX-License-Identifier: MIT
"""Tasks are mapped in order, one at a time, and no further than asked."""

from model.mapping import Here


def test_results_come_in_order_and_no_earlier_than_asked_for():
    done = []

    def times(factor, task):
        done.append(task)
        return factor * task

    results = Here().map(times, 10, [3, 1, 2])
    assert next(results) == 30
    assert done == [3]
    results.close()
    assert list(Here().map(times, 10, [3, 1, 2])) == [30, 10, 20]
