# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from rig.profile import shipped_file
from rig.sample_columns import SampleColumns
from zebro_lab.files.errors import DataError
from zebro_lab.runs.manifest import RIG, profile_file
from zebro_lab.runs.slip_rig_decoding import averages_around, derive_table

PROFILE = shipped_file("rig-odrive-netft.toml").read_text()


def stream(times, counts, channels=None):
    n = len(times)
    channel = np.zeros(n, dtype=np.uint32) if channels is None else np.array(channels, np.uint32)
    return SampleColumns(
        np.array(times), np.full(n, np.nan), np.full(n, -1), np.zeros(n, np.uint32), channel,
        np.array(counts, dtype=float),
    )  # fmt: skip


def derive(folder, force_times, forces=None):
    file = profile_file(folder, RIG)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(PROFILE)
    streams = {
        "/drives/raw": stream([0.1, 0.1, 0.3, 0.3], [[0, 2.0], [0, 0.5]] * 2, [0, 1, 0, 1]),
        "/load_cell/raw": stream(
            force_times, forces or [[1e6, 0, -5e6, 0, 0, 0]] * len(force_times)
        ),
    }
    return derive_table(folder, streams, zero={})


def test_forces_outside_the_speeds_are_left_out(tmp_path):
    table, _ = derive(tmp_path, [0.05, 0.2, 0.35])
    np.testing.assert_allclose(table.rows(), [[0.2, 4 * np.pi, np.pi, 5.0, 1.0]], rtol=1e-12)


def test_the_third_axis_is_the_lateral_force(tmp_path):
    table, _ = derive(tmp_path, [0.15, 0.2], [[1e6, 2e6, -5e6, 0, 0, 0]] * 2)
    assert table.lateral_force is not None
    np.testing.assert_allclose(table.lateral_force, [2.0, 2.0], rtol=1e-12)
    np.testing.assert_allclose(table.normal_force, [5.0, 5.0], rtol=1e-12)
    assert table.rows().shape == (2, 5)


def test_a_run_whose_forces_and_speeds_never_meet_is_one_line(tmp_path):
    with pytest.raises(DataError, match="no force was recorded while both disc speeds"):
        derive(tmp_path, [0.05, 0.35])


def test_many_forces_are_averaged_about_few_speeds():
    t = np.arange(0.0, 1.0, 0.001)
    at = np.arange(0.1, 0.9, 0.01)
    found, means = averages_around(at, t, np.vstack([3.0 * t, np.full_like(t, 2.0)]))
    assert len(found) == len(at)
    np.testing.assert_allclose(means[0], 3.0 * at, atol=0.0016)  # half a sample
    np.testing.assert_allclose(means[1], 2.0, rtol=1e-12)


def test_no_force_is_used_twice_nor_far_from_any_speed():
    at = np.array([0.0, 0.01, 0.02, 0.03, 0.13, 0.14, 0.15])  # speeds were lost
    t = np.arange(-0.05, 0.2, 0.001)
    counted = np.ones_like(t)
    _, means = averages_around(at, t, np.vstack([counted, t]))
    np.testing.assert_allclose(means[0], 1.0)
    assert np.all(np.abs(means[1] - at) < 0.005)


def test_speeds_without_any_force_about_them_are_left_out():
    at = np.array([0.0, 0.01, 0.02, 0.03])
    t = np.concatenate([np.arange(-0.004, 0.004, 0.001), np.arange(0.026, 0.034, 0.001)])
    found, _ = averages_around(at, t, t[None])
    np.testing.assert_array_equal(found, [0, 3])
