# SPDX-License-Identifier: MIT
"""Time left, streams and their values fit into a terminal of any size."""

from pathlib import Path

import pytest

from rig.device import Counters
from zebro_lab.recording.drawing import ASCII, BLOCKS, draw_status, glyphs_of, time_left
from zebro_lab.recording.live_values import LiveValue
from zebro_lab.recording.status import RecordStatus, StreamStatus

CLOCK = {"offset": 0.0, "drift": 3.2e-5, "delay": 0.0, "offset_sd": 1e-3, "drift_sd": 6e-6}
STREAMS = {
    "legs": StreamStatus("sim:zebro", 100.2, Counters(received=1234), 0, CLOCK),
    "load_cell": StreamStatus("real", 7000.4, Counters(received=86000, lost=5, refused=3), 2),
}
VALUES = {
    "legs": [LiveValue(f"leg {n}", "deg", turns=True, value=60.0 * n) for n in range(1, 7)],
    "load_cell": [LiveValue("normal", "N", value=12.0), LiveValue("traction", "N", value=3.5)],
}
STATUS = RecordStatus(Path("run"), 15.0, 60.0, STREAMS)


def drawn(width, height, status=STATUS, **options):
    VALUES["load_cell"][0].history.extend([10.0, 11.0, 12.0])
    text = draw_status(status, VALUES, width=width, height=height, **options)
    return text.plain.split("\n")


def test_a_usual_terminal_shows_time_counters_clocks_and_values():
    lines = drawn(80, 24)
    assert lines[0].startswith("15 of 60 s recorded, 45 s left; q ends it ███")
    assert lines[1] == "legs SIMULATED, 100 Hz, 0 lost, 1234 received, clock 32 ± 12 ppm slower"
    assert lines[2].startswith("leg 1 ███")
    assert " 60 deg  leg 2 ███" in lines[2]
    assert lines[5] == "load_cell, 7000 Hz, 5 lost, 2 dropped, 3 rejected, 86000 received"
    assert "12.0 N  traction" in lines[6]


@pytest.mark.parametrize("width", [20, 40, 60, 80, 200])
@pytest.mark.parametrize("height", [3, 6, 10, 24])
def test_what_is_drawn_fits_and_keeps_the_time_and_what_is_simulated(width, height):
    lines = drawn(width, height)
    assert len(lines) < height
    assert max(map(len, lines)) < width
    assert lines[0].startswith("15 of 60 s")
    assert "legs SIMULATED" in lines[1]


def test_a_narrow_terminal_shows_every_leg():
    lines = drawn(40, 24)
    assert sum(line.count("leg ") for line in lines) == 6
    assert all("█" in line or "░" in line for line in lines if line.startswith("leg "))


def test_a_low_terminal_leaves_out_values_before_streams():
    for height, legs, forces in ((8, True, True), (7, True, False), (6, False, True)):
        lines = drawn(80, height)
        assert any(line.startswith("load_cell") for line in lines)
        assert any(line.startswith("leg 1") for line in lines) == legs
        assert any(line.startswith("normal") for line in lines) == forces


def test_the_bar_of_a_leg_is_its_share_of_a_turn():
    lines = drawn(80, 24)
    for line, leg in ((lines[2], 1), (lines[3], 3), (lines[4], 5)):
        bar = line.split("deg")[0]
        full, empty = bar.count("█"), bar.count("░")
        assert full / (full + empty) == pytest.approx(leg / 6, abs=0.03)


def test_noise_at_rest_is_not_drawn_large():
    value = LiveValue("roll", "deg", value=0.0)
    value.history.extend([0.01, -0.01] * 20)
    text = draw_status(STATUS, {"legs": [value]}, width=80, height=24).plain
    assert len(set(text.split("\n")[2]) & set(BLOCKS.levels)) <= 2


def test_a_terminal_without_blocks_gets_plain_characters():
    assert (glyphs_of("utf-8"), glyphs_of("ISO-8859-1")) == (BLOCKS, ASCII)
    assert "\n".join(drawn(80, 24, glyphs=ASCII)).isascii()


def test_a_stream_that_has_sent_nothing_is_waited_for():
    silent = {**STREAMS, "imu": StreamStatus("real", 0.0, Counters(), 0)}
    assert time_left(RecordStatus(Path("run"), 0.0, 9.0, silent)) == (
        "waiting for the first sample of imu"
    )
    assert time_left(RecordStatus(Path("run"), 7.0, None, STREAMS)) == "7 s recorded"
