# SPDX-License-Identifier: MIT
"""A gap in a leg log is bridged only where no leg can have changed its speed unseen."""

from pathlib import Path

import numpy as np
import pytest

from support.leg_motions import tripod
from support.leg_tables import leg_table
from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_gaps import bridged_gaps
from zebro_lab.tables.raw_table import RawTable

T = np.arange(0.0, 6.0, 0.01)
STEADY = leg_table(len(T)).drop(columns="t").to_numpy()
COUNT = 2 * np.pi / 100


def without(first, last, theta=STEADY):
    """Return times and angles without samples `first` to `last`."""
    kept = np.r_[0:first, last + 1 : len(T)]
    return T[kept], theta[kept]


def bridged(t, theta):
    return bridged_gaps(RawTable(Path("legs.csv"), {}), "t", t, theta, advice="cut it")


@pytest.mark.parametrize("theta", [STEADY, COUNT * np.round(STEADY / COUNT)])
def test_a_short_gap_of_steady_legs_is_bridged_and_told(theta):
    (note,) = bridged(*without(100, 110, theta))
    assert note.startswith("WARNING: leg log: no samples from 0.99 to 1.11 s; every leg keeps its")


def test_no_gap_gives_no_note():
    assert bridged(T, STEADY) == ()
    assert bridged(*without(100, 103)) == ()


def test_what_is_bridged_is_near_the_truth_wherever_the_gap_lies_in_a_gait():
    theta = tripod().angles(T)
    refused = 0
    for first in range(30, 260, 3):
        t, seen = without(first, first + 9, theta)
        try:
            bridged(t, seen)
        except DataError as error:
            assert "changes its speed in that time" in str(error)  # noqa: PT017 - it may pass, too
            refused += 1
            continue
        lost = slice(first, first + 10)
        lines = np.column_stack([np.interp(T[lost], t, leg) for leg in seen.T])
        assert np.abs(lines - theta[lost]).max() < 0.15
    assert 10 < refused < 70


@pytest.mark.parametrize(
    ("gap", "why"),
    [
        ((100, 130), "that is 0.32 s"),
        ((2, 12), "too few samples beside it"),
        ((586, 597), "too few samples beside it"),
    ],
)
def test_a_gap_that_says_too_little_is_refused_with_the_advice(gap, why):
    with pytest.raises(DataError, match=rf"time jumps from .*{why}.*: cut it") as refused:
        bridged(*without(*gap))
    assert refused.value.row == gap[0] + 1


def test_gaps_near_each_other_are_refused():
    lost = np.r_[100:111, 114:120]
    t, theta = np.delete(T, lost), np.delete(STEADY, lost, axis=0)
    with pytest.raises(DataError, match="another gap is too near"):
        bridged(t, theta)


def test_the_leg_that_changes_its_speed_is_named():
    theta = STEADY.copy()
    theta[105:, 3] += 5.0 * (T[105:] - T[105])
    with pytest.raises(DataError, match="leg 4 changes its speed in that time"):
        bridged(*without(100, 110, theta))
