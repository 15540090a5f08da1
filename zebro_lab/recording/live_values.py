# SPDX-License-Identifier: MIT
"""Newest values of recorded streams in the units of a display, with their recent history."""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from rig.errors import RigError
from rig.sample_columns import SampleColumns, as_columns
from zebro_lab.recording.status import StreamStatus
from zebro_lab.runs.signals import Curves, profile_of, stream_decoder

REMEMBERED: Final = 200
"""Number of values of a history: half a minute of a display."""
TURN: Final = 360.0
"""One turn [deg]."""
_NOT_SHOWN: Final = ("counts as sent", "angular rate", "specific force")


@dataclass
class LiveValue:
    """A quantity of a stream.

    Attributes:
        label: Name of the quantity, short.
        unit: Unit of the value.
        turns: Whether the value is an angle within a turn, 0 to 360 deg.
        value: Newest value; of forces and speeds the mean of the newest samples.
        history: Values before it, the newest last, at the times at which they were asked for.
    """

    label: str
    unit: str
    turns: bool = False
    value: float = float("nan")
    history: deque[float] = field(default_factory=lambda: deque(maxlen=REMEMBERED))


class LiveValues:
    """Newest values of all streams of a run, decoded by the profiles in its folder."""

    def __init__(self) -> None:
        self._decoders: dict[str, Callable[[Array, SampleColumns], Curves]] = {}
        self._values: dict[str, dict[str, LiveValue]] = {}

    def update(
        self, folder: Path, streams: Mapping[str, StreamStatus]
    ) -> Mapping[str, Iterable[LiveValue]]:
        """Take the newest samples of each stream and return its values, by the stream's name.

        Args:
            folder: The run folder.
            streams: Status of the streams.
        """
        for name, status in streams.items():
            samples = status.newest()
            if samples:
                self._decode(folder, name, as_columns(samples))
        return {name: tuple(values.values()) for name, values in self._values.items()}

    def _decode(self, folder: Path, name: str, samples: SampleColumns) -> None:
        try:
            if name not in self._decoders:
                self._decoders[name] = stream_decoder(name, profile_of(folder, name))
            for what, unit, _, lines in self._decoders[name](samples.host_time, samples):
                if what not in _NOT_SHOWN:
                    self._keep(name, what, unit, lines)
        except RigError:  # samples without one of two drives, or a profile that is gone
            return

    def _keep(self, name: str, what: str, unit: str, lines: Mapping[str, Array]) -> None:
        turns = unit == "rad"
        for label, values in lines.items():
            if len(values) == 0:
                continue
            short = f"{label} disc" if what.startswith("speed") else label
            known = self._values.setdefault(name, {}).setdefault(
                short, LiveValue(short, "deg" if turns else unit, turns)
            )
            if turns:
                known.value = float(np.degrees(values[-1])) % TURN
            else:
                known.value = float(values[-1] if unit == "deg" else np.mean(values))
            known.history.append(known.value)
