# SPDX-License-Identifier: MIT
"""Newest samples become values in the units of a display, by the profiles of the run folder."""

import numpy as np
import pytest

from rig.device import Counters, Sample
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.live_values import LiveValues
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
