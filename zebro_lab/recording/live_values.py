# SPDX-License-Identifier: MIT
"""Newest values of recorded streams in words, in the units of a display."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from rig.errors import RigError
from rig.sample_columns import SampleColumns, as_columns
from zebro_lab.recording.status import StreamStatus
from zebro_lab.runs.signals import Curves, profile_of, stream_decoder

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
    if unit == "rad":  # of a leg
        return f"{float(np.degrees(values[-1])) % 360:3.0f} deg"
    return f"{float(values[-1] if unit == 'deg' else np.mean(values)):6.1f} {unit}"
