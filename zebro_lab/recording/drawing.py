# SPDX-License-Identifier: MIT
"""Lines of a recording for people: time left, counters and values of streams, clocks of devices."""

import textwrap
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

import numpy as np
from rich.text import Text

from model.arrays import Array
from rig.clock_watch import ClockFit
from rig.errors import RigError
from rig.sample_columns import SampleColumns, as_columns
from zebro_lab.files.source_names import is_simulated
from zebro_lab.recording.status import RecordStatus, StreamStatus
from zebro_lab.runs.signals import Curves, profile_of, stream_decoder

WIDEST: Final = 100
"""Width beyond which a line grows no longer [columns]."""


def draw_status(
    status: RecordStatus, values: Mapping[str, str], *, width: int, height: int
) -> Text:
    """Draw a recording: what is left of it, then each stream with its newest values.

    Where the lines are more than `height`, a stream's values are left out, then the last streams.

    Args:
        status: Status of the recording.
        values: Newest values by the stream's name, in words.
        width: Width of the terminal [columns].
        height: Height of the terminal [lines].
    """
    width = min(width, WIDEST) - 1
    room = height - 2 - len(status.streams)
    lines = [Text(f"{time_left(status)}; q ends it"[:width], style="bold")]
    for name, stream in status.streams.items():
        troubled = stream.counters.lost or stream.counters.rejected or stream.dropped
        style = "bold red" if troubled else "bold cyan"
        lines.append(Text(stream_in_words(name, stream)[:width], style=style))
        rows = textwrap.wrap(values.get(name, ""), width)
        if len(rows) <= room:
            lines.extend(map(Text, rows))
            room -= len(rows)
    return Text("\n", no_wrap=True, overflow="crop").join(lines[: max(height - 1, 1)])


def time_left(status: RecordStatus) -> str:
    """Return how long a recording has lasted and what is left of it, or what it waits for."""
    silent = [name for name, each in status.streams.items() if each.counters.received == 0]
    if silent and status.elapsed == 0:
        return f"waiting for the first sample of {', '.join(silent)}"
    if status.duration is None:
        return f"{status.elapsed:.0f} s recorded"
    left = max(status.duration - status.elapsed, 0.0)
    return f"{status.elapsed:.0f} of {round(status.duration, 1):g} s recorded, {left:.0f} s left"


def stream_in_words(name: str, stream: StreamStatus) -> str:
    """Return rate and counters of a stream; dropped and rejected samples where there are any.

    Args:
        name: Name of the stream.
        stream: Its status.
    """
    counters = stream.counters
    simulated = " SIMULATED" if is_simulated(stream.source) else ""
    said = [f"{name}{simulated}", f"{stream.rate:.0f} Hz", f"{counters.lost} lost"]
    if stream.dropped:
        said.append(f"{stream.dropped} dropped")
    if counters.rejected:
        said.append(f"{counters.rejected} rejected")
    return ", ".join([*said, f"{counters.received} received"])


_SDS: Final = 2.0
"""Half width of an interval, in standard uncertainties."""
_PPM: Final = 1e6


def with_uncertainty(value: float, half_width: float) -> str:
    """Format a value and its uncertainty, both to the first two digits of the latter.

    The value is alone if the uncertainty is 0 or not finite.

    Args:
        value: Value, in any unit.
        half_width: Half width of the interval around it, in the same unit.

    >>> with_uncertainty(324.4, 41.03), with_uncertainty(0.00173312, 0.0005)
    ('324 ± 41', '0.00173 ± 0.00050')
    """
    if not (half_width > 0 and np.isfinite(half_width)):
        return f"{value:g}"
    digits = 1 - int(np.floor(np.log10(half_width)))
    shown = max(digits, 0)
    return f"{round(value, digits):.{shown}f} ± {round(half_width, digits):.{shown}f}"


def clock_in_words(name: str, clock: Mapping[str, float]) -> str:
    """Return a sentence on the clock of a stream: pace, offset and delay.

    Args:
        name: Name of the stream.
        clock: Attributes of `ClockFit`.
    """
    offset = with_uncertainty(clock["offset"], _SDS * clock["offset_sd"])
    pace = (
        f"runs {_pace(clock)} than this computer's"
        if ClockFit(**clock).tells_drift
        else "its pace is not testable in so short a time"
    )
    return (
        f"clock of {name}: {pace}, shows 0 s at {offset} s of the run; in half of the intervals of "
        f"50 ms or more even the quickest sample came more than {1e3 * clock['delay']:.2g} ms late"
    )


def _pace(clock: Mapping[str, float]) -> str:
    """Format how much slower or faster a device's clock runs than the computer's [ppm]."""
    drift = with_uncertainty(_PPM * abs(clock["drift"]), _SDS * _PPM * clock["drift_sd"])
    return f"{drift} ppm {'slower' if clock['drift'] > 0 else 'faster'}"


_NOT_SHOWN: Final = ("counts as sent", "angular rate", "specific force")


class LiveValues:
    """Newest values of all streams of a run, decoded by the profiles in its folder."""

    def __init__(self) -> None:
        self._decoders: dict[str, Callable[[Array, SampleColumns], Curves]] = {}
        self._values: dict[str, dict[str, str]] = {}

    def update(self, folder: Path, streams: Mapping[str, StreamStatus]) -> Mapping[str, str]:
        """Take the newest samples of each stream and return its values, by the stream's name.

        Leg angles are within a turn; forces and speeds are means of the newest samples.

        Args:
            folder: The run folder.
            streams: Status of the streams.
        """
        for name, status in streams.items():
            samples = status.newest()
            if samples:
                self._decode(folder, name, as_columns(samples))
        return {
            name: ", ".join(f"{label} {value}" for label, value in values.items())
            for name, values in self._values.items()
        }

    def _decode(self, folder: Path, name: str, samples: SampleColumns) -> None:
        """Decode new samples of a stream and store its values in words, each by its label.

        Samples that cannot be decoded leave the values as they were.
        """
        try:
            if name not in self._decoders:
                self._decoders[name] = stream_decoder(name, profile_of(folder, name))
            for what, unit, _, lines in self._decoders[name](samples.host_time, samples):
                for label, values in lines.items() if what not in _NOT_SHOWN else ():
                    if len(values):
                        short = f"{label} disc" if what.startswith("speed") else label
                        self._values.setdefault(name, {})[short] = _in_words(values, unit)
        except RigError:  # samples without one of two drives, or a profile that is gone
            return


def _in_words(values: Array, unit: str) -> str:
    """Format values: leg angles [rad] and angles [deg] as the newest, other values as the mean."""
    if unit == "rad":  # of a leg
        return f"{float(np.degrees(values[-1])) % 360:3.0f} deg"
    return f"{float(values[-1] if unit == 'deg' else np.mean(values)):6.1f} {unit}"
