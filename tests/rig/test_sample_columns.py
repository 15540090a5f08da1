# SPDX-License-Identifier: MIT
"""Columns are the samples they were made of, in every way that a list of samples is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.device import Sample
from rig.sample_columns import SampleColumns, as_columns

SAMPLES = st.lists(
    st.builds(
        Sample,
        host_time=st.floats(0, 1e6),
        device_time=st.none() | st.floats(0, 1e6),
        sequence=st.none() | st.integers(0, 2**62),
        counts=st.tuples(*[st.integers(-(2**31), 2**31 - 1)] * 3),
        status=st.integers(0, 2**32 - 1),
        channel=st.integers(0, 63),
    ),
    min_size=1,
    max_size=8,
)


@given(SAMPLES, st.integers(-9, 9), st.integers(-9, 9), st.sampled_from([1, 2, -1]))
def test_columns_read_like_the_list_they_were_made_of(samples, first, last, step):
    columns = as_columns(samples, "<i4")
    assert list(columns) == samples
    assert [columns[row] for row in range(-len(samples), len(samples))] == samples * 2
    assert list(columns[first:last:step]) == samples[first:last:step]
    assert as_columns(columns) is columns
    with pytest.raises(IndexError):
        columns[len(samples)]


@given(st.lists(SAMPLES, min_size=1, max_size=4))
def test_parts_joined_are_the_whole(parts):
    whole = SampleColumns.joined([as_columns(part, "<i4") for part in parts])
    assert list(whole) == [sample for part in parts for sample in part]


def test_no_samples_are_empty_columns():
    assert not as_columns([])
    assert list(as_columns([])) == []


@pytest.mark.parametrize(
    ("counts", "error"), [(((1, 2), (3,)), ValueError), (((2**31,), (0,)), OverflowError)]
)
def test_counts_that_are_no_table_are_refused(counts, error):
    with pytest.raises(error):
        as_columns([Sample(0.0, None, None, row) for row in counts], "<i4")
