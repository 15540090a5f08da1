# SPDX-License-Identifier: MIT
"""An imported walk is a run folder like a recorded one."""

import numpy as np
import pytest

from rig.imu.profile import decode_orientation, load_imu_profile
from support.imported_files import COLUMNS, T, everything
from support.written_bags import imu, write_bag
from zebro_lab.exchange.imported_walk import read_imu_messages
from zebro_lab.files.errors import DataError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.manifest import profile_file, read_manifest
from zebro_lab.runs.signals import read_signals
from zebro_lab.runs.stage import list_runs


def test_a_run_says_what_it_was_made_from_and_is_listed(files, tmp_path):
    folder, notes = everything(files, tmp_path)
    manifest = read_manifest(folder)
    assert folder.name == "20260304T050607Z_walk_circle"
    assert (manifest.exit_status, manifest.source) == ("imported", "sim:other-lab")
    names = ["legs.csv", "imu.csv", "track.csv", "robot.toml", "columns.toml"]
    assert manifest.inputs == {str(files / n): file_hash(files / n) for n in names}
    (run,) = list_runs(tmp_path / "data")
    assert (run.state, run.duration) == ("imported", 1.98)
    assert run.samples == {"/legs/raw": 100, "/imu/raw": 100}
    assert any("no column of yaw" in note for note in notes)


def test_orientation_is_decoded_as_of_any_imu(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    stream = read_raw_log(folder / "log.mcap").streams["/imu/raw"]
    profile = load_imu_profile(str(profile_file(folder, "imu")))
    seen = decode_orientation(profile, stream)
    np.testing.assert_allclose(seen.roll, 0.1 * np.sin(T), atol=1e-12)
    np.testing.assert_allclose(seen.pitch, 0.2 * np.cos(T), atol=1e-12)
    np.testing.assert_allclose(stream.counts[:, 6], np.radians(5.0))
    assert np.isnan(stream.counts[:, [4, 5, 7, 8, 9]]).all()


def test_a_plot_shows_what_the_files_have_and_nothing_else(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    shown = {panel.title: list(panel.lines) for panel in read_signals(folder).panels}
    legs = [f"leg {leg}" for leg in range(1, 7)]
    assert shown == {
        "legs: counts as sent": legs, "legs: angles, unwrapped": legs,
        "imu: orientation": ["roll", "pitch"], "imu: angular rate": ["z"],
    }  # fmt: skip


def test_nobody_stated_a_source_so_that_the_file_is_it(files, tmp_path):
    (files / "columns.toml").write_text(COLUMNS.replace('source = "sim:other-lab"', ""))
    folder, _ = everything(files, tmp_path)
    assert read_manifest(folder).source == "import:legs.csv+imu.csv"


TIMES = np.arange(0.0, 1.0, 0.1)


def test_orientation_rate_and_force_are_read(tmp_path):
    table, topic = read_imu_messages(write_bag(tmp_path / "bag", imu(TIMES), storage="mcap"))
    assert topic == "/imu"
    assert table.notes == ("bag: topic /imu, sensor_msgs/msg/Imu, 10 messages",)
    np.testing.assert_allclose(table.numbers("qz"), np.sin(0.05 * TIMES), atol=1e-12)
    np.testing.assert_allclose(table.numbers("qw"), np.cos(0.05 * TIMES), atol=1e-12)
    assert set(table.numbers("rate_z")) == {0.1}
    assert set(table.numbers("force_z")) == {9.81}


def test_what_is_not_measured_has_no_column(tmp_path):
    absent = ("angular_velocity", "linear_acceleration")
    bag = write_bag(tmp_path / "bag", imu(TIMES, absent=absent), storage="mcap")
    table, _ = read_imu_messages(bag)
    assert list(table.columns) == ["t", "qw", "qx", "qy", "qz"]


def test_messages_without_orientation_are_refused(tmp_path):
    bag = write_bag(tmp_path / "bag", imu(TIMES, absent=("orientation",)), storage="mcap")
    with pytest.raises(DataError, match=r"has no orientation on topic /imu: .* covariance is -1"):
        read_imu_messages(bag)
