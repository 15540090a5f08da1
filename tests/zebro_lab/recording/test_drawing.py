# SPDX-License-Identifier: MIT
"""Time left, streams and their values fit into a terminal of any size."""

from pathlib import Path

import numpy as np
import pytest

from rig.clock_watch import DRIFT_SD
from rig.device import Counters, Sample
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.drawing import LiveValues, clock_in_words, draw_status, time_left
from zebro_lab.recording.status import RecordStatus, StreamStatus
from zebro_lab.runs.manifest import profile_file

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


CLOCK = {"offset": 0.0017331, "drift": -3.2443e-4, "delay": 0.00408, "offset_sd": 2.5e-4,
         "drift_sd": 2.05e-5}  # fmt: skip


def test_a_clock_is_told_with_its_uncertainty():
    text = clock_in_words("legs", CLOCK)
    assert "clock of legs: runs 324 ± 41 ppm faster than this computer's" in text
    assert "shows 0 s at 0.00173 ± 0.00050 s of the run" in text
    assert "more than 4.1 ms late" in text


def test_a_clock_seen_for_a_moment_is_not_testable():
    moment = CLOCK | {"drift_sd": DRIFT_SD}
    assert "not testable in so short a time" in clock_in_words("imu", moment)
    assert "ppm" not in clock_in_words("imu", moment)


def status(samples):
    return StreamStatus("real", 0.0, Counters(), 0, newest=lambda: samples)


def sample(counts, channel=0):
    return Sample(1.0, 1.0, 1, tuple(counts), channel=channel)


@pytest.fixture
def folder(tmp_path):
    for name, profile in (("legs", "zebro-100-serial"), ("imu2", "imu-quaternion-serial"),
                          ("rig", "rig-odrive-netft")):  # fmt: skip
        file = profile_file(tmp_path, name)
        file.parent.mkdir(exist_ok=True)
        file.write_text(profile_text(profile))
    return tmp_path


def test_leg_angles_are_degrees_within_a_turn(folder):
    values = LiveValues().update(folder, {"legs": status([sample([25, 50, 75, 100, 130, 0])])})
    angles = [float(part.split()[2]) for part in values["legs"].split(", ")]
    assert len(angles) == 6
    assert all(0 <= angle < 360 for angle in angles)
    assert (angles[1] - angles[0]) % 360 in (90, 270)


def test_forces_are_means_and_the_attitude_is_the_newest(folder):
    half = round(16384 * np.sqrt(0.5))
    turned = [sample([16384, 0, 0, 0] + [0] * 6), sample([half, 0, 0, half] + [0] * 6)]
    forces = [sample([0, 0, 1_000_000 * n, 0, 0, 0]) for n in (1, 3)]
    values = LiveValues().update(folder, {"imu2": status(turned), "load_cell": status(forces)})
    assert abs(float(values["imu2"].split("yaw")[1].split()[0])) == pytest.approx(90.0, abs=0.1)
    by_half = LiveValues().update(folder, {"load_cell": status(forces[:1])})
    normal, before = (float(each["load_cell"].split()[1]) for each in (values, by_half))
    assert normal == pytest.approx(2 * before, abs=0.2)


def test_a_stream_that_cannot_be_decoded_has_no_values(folder, tmp_path):
    live = LiveValues()
    assert live.update(tmp_path / "gone", {"legs": status([sample([1] * 6)])}) == {}
    one_drive = [sample([0.0, 0.5], channel=0)]
    shown = live.update(folder, {"drives": status(one_drive)}).get("drives", "")
    assert shown.startswith("leg disc")
