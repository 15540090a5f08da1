# SPDX-License-Identifier: MIT
"""Dates and times of day become seconds."""

from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from zebro_lab.files.errors import DataError
from zebro_lab.tables.date_cells import seconds_of_dates
from zebro_lab.tables.raw_table import RawTable

MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
MOMENTS = st.datetimes(datetime(1971, 1, 1), datetime(2200, 1, 1))


def seconds(*cells, unit="date"):
    table = RawTable(Path("a.csv"), {"t": pd.Series(list(cells), dtype=object)})
    return seconds_of_dates(table, "t", unit)


@given(MOMENTS, st.integers(-12, 14))
def test_dates_with_a_zone_are_unix_time(moment, hours):
    zoned = moment.replace(tzinfo=timezone(timedelta(hours=hours)))
    assert seconds(zoned.isoformat())[0] == pytest.approx(zoned.timestamp(), abs=1e-5)


@settings(max_examples=30)
@given(MOMENTS)
def test_dates_without_a_zone_are_in_the_one_that_is_stated(moment):
    utc = moment.replace(tzinfo=UTC).timestamp()
    text = moment.strftime("%d.%m.") + f"{moment.year:04d} " + moment.time().isoformat()
    named = f"{moment.day:02d}-{MONTHS[moment.month - 1]}-{moment.year} {moment.time().isoformat()}"
    cells = (named, moment.isoformat(" "), moment.isoformat().replace(".", ","), text, moment)
    np.testing.assert_allclose(seconds(*cells, unit="date UTC"), utc, atol=1e-5)
    np.testing.assert_allclose(seconds(*cells, unit="date +01:30"), utc - 5400, atol=1e-5)


def test_times_of_day_count_from_midnight_and_empty_cells_are_nan():
    found = seconds("01:02:03,5", None, "00:00:00", unit="h:m:s")
    np.testing.assert_array_equal(found, [3723.5, np.nan, 0])


def test_times_of_day_go_on_past_midnight_and_an_earlier_one_of_the_day_stays():
    cells = ("23:59:59", None, "00:00:01", "00:00:00", "23:59:59", "00:00:02")
    expected = [86399, np.nan, 86401, 86400, 172799, 172802]
    np.testing.assert_array_equal(seconds(*cells, unit="h:m:s"), expected)


@pytest.mark.parametrize(
    ("cell", "unit", "problem"),
    [
        ("2026-03-04 05:06:07", "date", "has no time zone; state it in columns.toml"),
        ("2026-03-04T05:06:07Z", "date UTC", "has a time zone of its own"),
        ("03/04/2026 05:06", "date UTC", "is not read as a date or time; write 2026-03-04T"),
        ("2026-13-04 05:06", "date UTC", "is not read as a date"),
        ("00:05.10", "h:m:s", "is not read as a date or time; write 12:00:00.5"),
        ("02:05:06 PM", "h:m:s", "is not read as a date or time; write 12:00:00.5"),
        ("noon", "h:m:s", "is not read as a date or time; write 12:00:00.5"),
    ],
)
def test_what_is_no_date_is_named(cell, unit, problem):
    with pytest.raises(DataError, match=f"column 't', row 1.*{problem}"):
        seconds(cell, unit=unit)


def test_numbers_are_no_dates():
    with pytest.raises(DataError, match="holds numbers; expected dates"):
        seconds_of_dates(RawTable(Path("a.csv"), {"t": pd.Series([1.0])}), "t", "date")
