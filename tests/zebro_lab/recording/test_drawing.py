# SPDX-License-Identifier: MIT
"""Time left, streams and their values fit into a terminal of any size."""

from pathlib import Path

import pytest

from rig.device import Counters
from zebro_lab.recording.drawing import draw_status, time_left
from zebro_lab.recording.status import RecordStatus, StreamStatus

STREAMS = {
    "legs": StreamStatus("sim:zebro", 100.2, Counters(received=1234), 0),
    "load_cell": StreamStatus("real", 7000.4, Counters(received=86000, lost=5, refused=3), 2),
}
VALUES = {
    "legs": ", ".join(f"leg {n}  60 deg" for n in range(1, 7)),
    "load_cell": "normal   12.0 N, traction    3.5 N",
}
STATUS = RecordStatus(Path("run"), 15.0, 60.0, STREAMS)


def drawn(width, height):
    return draw_status(STATUS, VALUES, width=width, height=height).plain.split("\n")


def test_a_usual_terminal_shows_time_counters_and_values():
    assert drawn(100, 24) == [
        "15 of 60 s recorded, 45 s left; q ends it",
        "legs SIMULATED, 100 Hz, 0 lost, 1234 received",
        VALUES["legs"],
        "load_cell, 7000 Hz, 5 lost, 2 dropped, 3 rejected, 86000 received",
        VALUES["load_cell"],
    ]


@pytest.mark.parametrize("width", [20, 40, 80, 200])
@pytest.mark.parametrize("height", [3, 6, 10, 24])
def test_what_is_drawn_fits_and_keeps_the_time_and_what_is_simulated(width, height):
    lines = drawn(width, height)
    assert len(lines) < height
    assert max(map(len, lines)) < width
    assert lines[0].startswith("15 of 60 s")
    assert "legs SIMULATED" in lines[1]


def test_a_stream_that_has_sent_nothing_is_waited_for():
    silent = {**STREAMS, "imu": StreamStatus("real", 0.0, Counters(), 0)}
    assert time_left(RecordStatus(Path("run"), 0.0, 9.0, silent)) == (
        "waiting for the first sample of imu"
    )
    assert time_left(RecordStatus(Path("run"), 7.0, None, STREAMS)) == "7 s recorded"
