# SPDX-License-Identifier: MIT
"""Count photographs' times from the run's start, a given moment, or the first photograph."""

from dataclasses import dataclass
from datetime import UTC, datetime

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
        times: Times and their standard deviations [s]; None for exposures that are not found yet.
        description: Source and origin of the times, in words.
        notes: Notes on photographs outside the run or not tied to its time, one line each.
    """

    times: PhotoTimes | None
    description: str
    notes: tuple[str, ...] = ()


def counted_from(
    times: PhotoTimes, *, start: datetime | None, manifest: RunManifest | None, request: TimeRequest
) -> CountedTimes:
    """Subtract the time origin from a clock's times; leave those of an interval, table or video.

    The origin is `start`; else the run's start if the camera's clock is tied to the computer's by
    `request.clock`; else the first photograph, with a note where there is a run.

    Args:
        times: Times of the photographs [s]: since 1970 if by a clock, else as given.
        start: Moment from which to count, by the camera's clock; None without.
        manifest: Manifest of the photographed run; None without.
        request: How the photographs got their times.

    Raises:
        SettingsError: A moment is given, but the photographs' times are not a clock's.
        TimesError: All photographs were taken over a minute before or after the run.
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
        notes = (
            *_dated_apart(zero, manifest),
            *unknown_start("give --clock (docs/tracking-howto.md) or --start, or "),
        )
    counted = PhotoTimes(times.t - zero, times.sd, times.source)
    if manifest is not None and not notes:
        notes = _outside_run(counted, manifest)
    return CountedTimes(counted, f"{times.source}; counted from {what}", notes)


def counted_later(*, manifest: RunManifest | None, request: TimeRequest) -> CountedTimes:
    """Describe the times of a composite picture's exposures before these are found.

    Args:
        manifest: Manifest of the photographed run; None without.
        request: How the exposures get their times.

    Returns:
        No times; a description, and a note if there is a run and no table ties the times to it.
    """
    notes = ()
    if manifest is not None and request.table is None:
        notes = unknown_start("give seconds since the run's start as --times, or ")
    return CountedTimes(None, "times of exposures from --interval or --times", notes)


def unknown_start(advice: str) -> tuple[str, ...]:
    """Return the note, one line, that times are not tied to the run's.

    Args:
        advice: What else to do, ending with ", or ", as `--time-offset` follows; may be empty.
    """
    return (
        "time is counted from the first photograph; when it was taken within the run is unknown: "
        f"{advice}bring it to the run's clock with `validate --time-offset`",
    )


def _dated_apart(zero: float, manifest: RunManifest) -> tuple[str, ...]:
    """Return a note if run and first photograph are over a day apart.

    Args:
        zero: Time of the first photograph since 1970, by the camera's clock [s].
        manifest: Manifest of the run.
    """
    days = abs(zero - manifest.began.timestamp()) / 86_400
    if days <= 1.0:
        return ()
    return (
        f"EXIF dates the photographs {datetime.fromtimestamp(zero, UTC):%Y-%m-%d}, and the run is "
        f"of {manifest.began:%Y-%m-%d}, {days:.0f} days apart: are they of another run?",
    )


def _by_a_clock(times: PhotoTimes) -> bool:
    """Return whether the first time is above `_CLOCK`: counted from 1970, not from 0."""
    return len(times.t) > 0 and float(times.t[0]) > _CLOCK


def _as_given(
    times: PhotoTimes, start: datetime | None, manifest: RunManifest | None, request: TimeRequest
) -> CountedTimes:
    """Return times that are not those of a clock unchanged, with a note if their origin is unknown.

    The note is for photographs of a run; a table's times are counted from its start.

    Raises:
        SettingsError: A moment `start` is given; only times of a clock can be counted from it.
    """
    if start is not None:
        raise SettingsError(
            f"the photographs' times are not those of a camera's clock ({times.source}), which "
            "a moment needs; leave the option out",
            key="--start",
        )
    if manifest is None or request.table is not None:
        return CountedTimes(times, times.source)
    advice = "" if request.interval is None else "give --times, or "
    return CountedTimes(times, times.source, unknown_start(advice))


def _outside_run(counted: PhotoTimes, manifest: RunManifest) -> tuple[str, ...]:
    """Return a note with the number of photographs before or after the run, empty without any.

    Raises:
        TimesError: All photographs were taken over a minute before or after the run.
    """
    length = float("inf")
    if manifest.stop is not None:
        length = (datetime.fromisoformat(manifest.stop) - manifest.began).total_seconds()
    first, last = float(counted.t.min()), float(counted.t.max())
    if last < -_RUN_TOLERANCE or first > length + _RUN_TOLERANCE:
        end = "has no end in run.json" if manifest.stop is None else f"lasted {length:.1f} s"
        raise TimesError(
            f"the photographs were taken {first:.1f} to {last:.1f} s after the run's start, and "
            f"the run {end}; give their run as --run, or give as --start the moment of the run's "
            "start as the camera's clock shows it"
        )
    outside = int(((counted.t < 0) | (counted.t > length)).sum())
    if not outside:
        return ()
    return (f"{outside} of {len(counted.t)} photographs were taken before or after the run",)
