# SPDX-License-Identifier: MIT
"""Lines of a live display: time left, counters of each stream, its newest values."""

import textwrap
from collections.abc import Mapping
from typing import Final

from rich.text import Text

from zebro_lab.files.source_names import is_simulated
from zebro_lab.recording.status import RecordStatus, StreamStatus

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
