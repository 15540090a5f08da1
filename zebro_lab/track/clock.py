# SPDX-License-Identifier: MIT
"""Time origin of a track: the run's start, a given moment, or the first photograph."""

from dataclasses import dataclass
from datetime import datetime

from tracking.errors import TimesError
from tracking.images import PhotoTimes
from zebro_lab.files.errors import SettingsError
from zebro_lab.runs.manifest import RunManifest
from zebro_lab.track.request import TimeRequest

_CLOCK = 1e8  # larger times are a clock's, counted from 1970 [s]
_RUN_TOLERANCE = 60.0  # tolerance before and after a run for photographs of it [s]


@dataclass(frozen=True)
class CountedTimes:
    """Times of photographs relative to the track's origin.

    Attributes:
        times: Times and their standard deviations; None for exposures that are not found yet.
        description: Their source and origin, in words.
        notes: Notes for the user, one line each.
    """

    times: PhotoTimes | None
    description: str
    notes: tuple[str, ...] = ()


def counted_from(
    times: PhotoTimes, *, start: datetime | None, manifest: RunManifest | None, request: TimeRequest
) -> CountedTimes:
    """Subtract the time origin: the given moment, the run's start, or the first photograph.

    Args:
        times: Times of the photographs: since 1970 where they are a clock's, else as given.
        start: The moment given, by the camera's clock.
        manifest: The run they belong to.
        request: How the photographs got their times.

    Raises:
        SettingsError: A moment is given, but the photographs' times are not a clock's.
        TimesError: All photographs were taken long before or after the run.
    """
    if request.interval is not None or request.table is not None or not _by_a_clock(times):
        return _as_given(times, start, manifest, request)
    zero, what, notes = float(times.t[0]), "the first photograph", ()
    if start is not None:
        zero, what = start.timestamp(), f"{start:%Y-%m-%d %H:%M:%S} by the camera's clock"
    elif manifest is not None and request.clock is not None:
        zero = manifest.began.timestamp()
        what = f"the run's start, {manifest.start}"
    elif manifest is not None:
        notes = unknown_start("give --clock (docs/tracking-howto.md) or --start, or ")
    counted = PhotoTimes(times.t - zero, times.sd, times.source)
    if manifest is not None and not notes:
        notes = _outside_run(counted, manifest)
    return CountedTimes(counted, f"{times.source}; counted from {what}", notes)


def counted_later(*, manifest: RunManifest | None, request: TimeRequest) -> CountedTimes:
    """Describe the times of a composite picture's exposures before these are found.

    Args:
        manifest: The run they belong to, or None.
        request: How the exposures get their times.

    Returns:
        No times yet; a description, and a note where they are not tied to the run.
    """
    notes = ()
    if manifest is not None and request.table is None:
        notes = unknown_start("give seconds since the run's start as --times, or ")
    return CountedTimes(None, "times of exposures as given", notes)


def unknown_start(advice: str) -> tuple[str, ...]:
    """Note that the photographs' times are not tied to the run's, and what to do about it."""
    return (
        "time is counted from the first photograph; when it was taken within the run is unknown: "
        f"{advice}bring it to the run's clock with `validate --time-offset`",
    )


def _by_a_clock(times: PhotoTimes) -> bool:
    return len(times.t) > 0 and float(times.t[0]) > _CLOCK


def _as_given(
    times: PhotoTimes, start: datetime | None, manifest: RunManifest | None, request: TimeRequest
) -> CountedTimes:
    if start is not None:
        raise SettingsError(
            f"these photographs' times are not a camera clock's ({times.source}), which a moment "
            "needs; leave it out",
            key="--start",
        )
    if manifest is None or request.table is not None:
        return CountedTimes(times, times.source)
    advice = "" if request.interval is None else "give --times, or "
    return CountedTimes(times, times.source, unknown_start(advice))


def _outside_run(counted: PhotoTimes, manifest: RunManifest) -> tuple[str, ...]:
    """Note photographs outside the run's duration; raise if all are far from it."""
    length = float("inf")
    if manifest.stop is not None:
        length = (datetime.fromisoformat(manifest.stop) - manifest.began).total_seconds()
    first, last = float(counted.t.min()), float(counted.t.max())
    if last < -_RUN_TOLERANCE or first > length + _RUN_TOLERANCE:
        raise TimesError(
            f"the photographs were taken {first:.1f} to {last:.1f} s after the run's start, and "
            f"the run lasted {length:.1f} s; name the run they belong to, or correct --start (the "
            "moment of the run's start as the camera's clock shows it)"
        )
    outside = int(((counted.t < 0) | (counted.t > length)).sum())
    if not outside:
        return ()
    return (f"{outside} of {len(counted.t)} photographs were taken before or after the run",)
