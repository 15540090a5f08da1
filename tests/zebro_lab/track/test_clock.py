# SPDX-License-Identifier: MIT
"""Time is counted from the run's start only where the clocks are tied."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from tracking.errors import TimesError
from tracking.images import PhotoTimes
from zebro_lab.files.errors import SettingsError
from zebro_lab.runs.manifest import RunManifest
from zebro_lab.track.clock import counted_from
from zebro_lab.track.request import TimeRequest

START = datetime(2020, 6, 1, 12, 0, 0, tzinfo=UTC)
STARTED = START.timestamp()


def run_starting(start: str) -> RunManifest:
    return RunManifest(
        kind="walk", label="w", material="", operator="", source="real", start=start, stop=None,
        exit_status="completed", software={}, constants={}, streams={}, log_sha256=None,
    )  # fmt: skip


def test_time_is_counted_from_the_run_only_where_the_clocks_are_tied():
    times = PhotoTimes(STARTED + np.array([3.0, 5.0]), np.zeros(2), "EXIF")
    manifest = run_starting(START.isoformat())

    def counted(start=None, manifest=None, clock=None):
        return counted_from(times, start=start, manifest=manifest, request=TimeRequest(clock=clock))

    tied = counted(manifest=manifest, clock=Path("clock.jpg"))
    np.testing.assert_allclose(tied.times.t, [3, 5])
    assert "the run's start" in tied.description
    assert tied.notes == ()
    loose = counted(manifest=manifest)
    np.testing.assert_allclose(loose.times.t, [0, 2])
    assert "when it was taken within the run is unknown" in loose.notes[0]
    later = counted(manifest=run_starting("2026-06-01T12:00:00+00:00"))
    assert "EXIF dates the photographs 2020-06-01, and the run is of 2026-06-01" in later.notes[0]
    np.testing.assert_allclose(counted(START - timedelta(seconds=1)).times.t, [4, 6])
    with pytest.raises(TimesError, match=r"7203\.0 to 7205\.0 s after the run's start"):
        counted(START - timedelta(hours=2), replace(manifest, stop=START.isoformat()))


def test_times_as_given_are_left_as_given_and_have_no_moment():
    times, asked = PhotoTimes(np.array([3.0, 5.0]), np.zeros(2), "interval"), TimeRequest(2.0)
    assert counted_from(times, start=None, manifest=None, request=asked).times is times
    with pytest.raises(SettingsError, match="--start"):
        counted_from(times, start=START, manifest=None, request=asked)
