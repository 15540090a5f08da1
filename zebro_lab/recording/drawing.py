# SPDX-License-Identifier: MIT
"""Lines of a live display: time left, counters and clock of each stream, values as bars."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from rich.text import Text

from zebro_lab.files.source_names import is_simulated
from zebro_lab.recording.clock_text import short_drift
from zebro_lab.recording.live_values import TURN, LiveValue
from zebro_lab.recording.status import RecordStatus, StreamStatus

LEAST_PICTURE: Final = 4
"""Least width of bars and lines over time that are drawn beside each other [columns]."""
LEAST_SPAN: Final = {"deg": 2.0, "N": 1.0, "rad/s": 0.5}
"""Least span of a line over time by unit, so that noise at rest is not drawn large."""
WIDEST: Final = 100
"""Width beyond which a line grows no longer [columns]."""
_PIECES: Final = ("name", "rate", "lost", "dropped", "rejected", "received", "clock")


@dataclass(frozen=True)
class Glyphs:
    """Characters of bars and of lines over time.

    Attributes:
        full: Filled part of a bar.
        empty: Rest of a bar.
        levels: Levels of a line over time, the lowest first.
        plus_minus: Sign of an uncertainty.
    """

    full: str
    empty: str
    levels: str
    plus_minus: str


BLOCKS: Final = Glyphs("█", "░", "▁▂▃▄▅▆▇█", "±")
ASCII: Final = Glyphs("#", ".", "_.-~=+*#", "+-")


def glyphs_of(encoding: str) -> Glyphs:
    """Return the characters that a terminal of this encoding can show."""
    return BLOCKS if encoding.lower().startswith("utf") else ASCII


def draw_status(
    status: RecordStatus,
    values: Mapping[str, Iterable[LiveValue]],
    *,
    width: int,
    height: int,
    glyphs: Glyphs = BLOCKS,
) -> Text:
    """Draw a recording: what is left of it, then each stream with its values.

    Where the lines are more than `height`, a stream's values are left out, then the last streams.

    Args:
        status: Status of the recording.
        values: Newest values by the stream's name.
        width: Width of the terminal [columns].
        height: Height of the terminal [lines].
        glyphs: Characters to draw with.
    """
    width = min(width, WIDEST) - 1
    heads = {name: _stream(name, stream, width, glyphs) for name, stream in status.streams.items()}
    room = height - 2 - len(heads)
    lines = [_time(status, width, glyphs)]
    for name, head in heads.items():
        lines.append(head)
        rows = _values(list(values.get(name, ())), width, glyphs)
        if len(rows) <= room:
            lines.extend(rows)
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


def stream_in_words(name: str, stream: StreamStatus) -> dict[str, str]:
    """Return what is said of a stream, by `_PIECES`; dropped and rejected where there are any.

    Args:
        name: Name of the stream.
        stream: Its status.
    """
    counters = stream.counters
    simulated = " SIMULATED" if is_simulated(stream.source) else ""
    said = {
        "name": name + simulated,
        "rate": f"{stream.rate:.0f} Hz",
        "received": f"{counters.received} received",
        "lost": f"{counters.lost} lost",
    }
    if stream.dropped:
        said["dropped"] = f"{stream.dropped} dropped"
    if counters.rejected:
        said["rejected"] = f"{counters.rejected} rejected"
    if stream.clock:
        said["clock"] = short_drift(stream.clock)
    return {key: said[key] for key in _PIECES if key in said}


def _time(status: RecordStatus, width: int, glyphs: Glyphs) -> Text:
    words, ends = time_left(status), "; q ends it"
    line = words + ends if len(words) + len(ends) <= width else words
    room = width - len(line) - 1
    if status.duration is not None and room >= 8:
        line += " " + _bar(status.elapsed / status.duration, min(room, 40), glyphs)
    return Text(line[:width], style="bold")


def _stream(name: str, stream: StreamStatus, width: int, glyphs: Glyphs) -> Text:
    """Draw the line of a stream; what does not fit is left out, the least important first."""
    said = stream_in_words(name, stream)
    while len(", ".join(said.values())) > width and len(said) > 2:
        said.popitem()
    troubled = stream.counters.lost or stream.counters.rejected or stream.dropped
    line = ", ".join(said.values()).replace(BLOCKS.plus_minus, glyphs.plus_minus)
    return Text(line[:width], style="bold red" if troubled else "bold cyan")


def _values(values: Sequence[LiveValue], width: int, glyphs: Glyphs) -> list[Text]:
    """Draw values, two to a line where there is room, such as left and right leg."""
    label = max((len(value.label) for value in values), default=0)
    numbers = [_number(value) for value in values]
    taken = label + max(map(len, numbers), default=0) + 2
    beside = 2 if (width - 2) // 2 - taken >= LEAST_PICTURE else 1
    room = max((width - 2) // beside - taken, 1)
    drawn = [
        f"{value.label:<{label}} {_picture(value, room, glyphs)} {number}"
        for value, number in zip(values, numbers, strict=True)
    ]
    lines = ("  ".join(drawn[i : i + beside]) for i in range(0, len(drawn), beside))
    return [Text(line[:width]) for line in lines]


def _number(value: LiveValue) -> str:
    if value.turns:
        return f"{value.value:3.0f} {value.unit}"
    return f"{value.value:6.1f} {value.unit}"


def _picture(value: LiveValue, width: int, glyphs: Glyphs) -> str:
    """Draw an angle within a turn as a bar, another value over time."""
    if value.turns:
        return _bar(value.value / TURN, width, glyphs)
    least = LEAST_SPAN.get(value.unit, 0.0)
    return _over_time(list(value.history)[-width:], width, glyphs, least_span=least)


def _bar(share: float, width: int, glyphs: Glyphs) -> str:
    full = int(np.clip(round(share * width), 0, width)) if np.isfinite(share) else 0
    return glyphs.full * full + glyphs.empty * (width - full)


def _over_time(history: Sequence[float], width: int, glyphs: Glyphs, *, least_span: float) -> str:
    """Draw values between the least and the greatest, which are `least_span` apart or more."""
    values = np.nan_to_num(np.array(history, dtype=float))
    if len(values) == 0:
        return " " * width
    middle, span = (values.max() + values.min()) / 2, max(np.ptp(values), least_span, 1e-12)
    highest = len(glyphs.levels) - 1
    levels = np.clip(np.rint(((values - middle) / span + 0.5) * highest), 0, highest)
    return "".join(glyphs.levels[int(k)] for k in levels).rjust(width)
