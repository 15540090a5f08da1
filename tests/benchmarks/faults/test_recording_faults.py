# SPDX-License-Identifier: MIT
"""The benchmark of faults while recording runs, and its tables say what recording promises."""

import sys

import pytest


@pytest.mark.skipif(sys.platform == "win32", reason="terminals and pipes of POSIX")
@pytest.mark.long
def test_one_trial_of_each_fault_is_a_row_and_nothing_is_lost(rows):
    from benchmarks.faults.recording_faults import main  # terminals of POSIX

    main(1, 1.5, fsync=1.0)  # a second less would not do for the clocks on a busy machine
    found = rows()
    by_name = {cells[0]: cells for cells in found}
    assert set(by_name) >= {"line on stderr", "process ended"}
    ends = [cells for cells in found if cells[0] in ("fsync takes 1 s", "terminal stopped",
                                                    "pipe full, nobody reads")]  # fmt: skip
    assert len(ends) == 4
    assert {cells[-1] for cells in ends} == {"0"}
    assert all(float(cells[4].split()[0]) > -1.0 for cells in ends)
