# SPDX-License-Identifier: MIT
"""Newest samples become values in the units of a display, by the profiles of the run folder."""

import numpy as np
import pytest

from rig.device import Counters, Sample
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.live_values import REMEMBERED, LiveValues
from zebro_lab.recording.status import StreamStatus
from zebro_lab.runs.manifest import profile_file


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
    assert [value.label for value in values["legs"]] == [f"leg {n}" for n in range(1, 7)]
    assert all(value.turns and value.unit == "deg" for value in values["legs"])
    assert all(0 <= value.value < 360 for value in values["legs"])
    quarter = (values["legs"][1].value - values["legs"][0].value) % 360
    assert quarter in (pytest.approx(90.0), pytest.approx(270.0))


def test_forces_are_means_and_the_attitude_is_the_newest(folder):
    half = round(16384 * np.sqrt(0.5))
    turned = [sample([16384, 0, 0, 0] + [0] * 6), sample([half, 0, 0, half] + [0] * 6)]
    forces = [sample([0, 0, 1_000_000 * n, 0, 0, 0]) for n in (1, 3)]
    values = LiveValues().update(folder, {"imu2": status(turned), "load_cell": status(forces)})
    yaw = next(value for value in values["imu2"] if value.label == "yaw")
    assert abs(yaw.value) == pytest.approx(90.0, abs=0.1)
    by_half = LiveValues().update(folder, {"load_cell": status(forces[:1])})
    normal, before = values["load_cell"][0], by_half["load_cell"][0]
    assert normal.value == pytest.approx(2 * before.value)


def test_a_history_grows_by_one_an_update_and_is_bounded(folder):
    live = LiveValues()
    for _ in range(REMEMBERED + 5):
        values = live.update(folder, {"legs": status([sample([1] * 6)] * 3)})
    assert len(values["legs"][0].history) == REMEMBERED
    again = live.update(folder, {"legs": status([])})
    assert len(again["legs"][0].history) == REMEMBERED


def test_a_stream_that_cannot_be_decoded_has_no_values(folder, tmp_path):
    live = LiveValues()
    assert live.update(tmp_path / "gone", {"legs": status([sample([1] * 6)])}) == {}
    one_drive = [sample([0.0, 0.5], channel=0)]
    shown = live.update(folder, {"drives": status(one_drive)}).get("drives", ())
    assert [value.label for value in shown] == ["leg disc"]
