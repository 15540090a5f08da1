# SPDX-License-Identifier: MIT
"""Every stream of a run becomes curves in SI, with its gaps."""

import numpy as np
import pytest

from support.written_runs import make_run, make_table
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.signals import find_gaps, read_signals
from zebro_lab.runs.slip_rig_decoding import averages_around

T = np.arange(0.0, 10.0, 0.01)


def test_every_stream_of_a_run_is_shown_as_what_the_stages_read(recorded):
    shown = {panel.title: panel for panel in read_signals(recorded).panels}
    assert set(shown) == {
        "legs: counts as sent", "legs: angles, unwrapped", "imu: orientation",
        "imu: angular rate", "imu: specific force", "drives: speed of the leg disc",
        "drives: speed of the ground disc", "load_cell: forces",
    }  # fmt: skip
    assert all(panel.simulated for panel in shown.values())
    forces, table = shown["load_cell: forces"], read_slip_rig_run(recorded).table
    at, means = averages_around(table.t, forces.t, forces.lines["normal"][None])
    assert len(at) == len(table)
    np.testing.assert_allclose(means[0, 1:-1], table.normal_force[1:-1], rtol=1e-3)
    texts = [event.text for event in read_signals(recorded).events]
    assert "began" in texts[0]
    assert "ended" in texts[-1]


def test_silences_and_missing_numbers_are_gaps_and_jitter_is_none():
    rng = np.random.default_rng(0)
    t = T + rng.uniform(0, 0.009, len(T))
    numbers = np.arange(len(t))
    assert len(find_gaps(t, numbers)) == 0
    kept = np.ones(len(t), dtype=bool)
    kept[300] = kept[500:600] = False
    found = find_gaps(t[kept], numbers[kept])
    np.testing.assert_array_equal(found, [[t[299], t[301]], [t[499], t[600]]])
    assert len(find_gaps(t[kept])) == 1  # without numbers one sample more or less is jitter


def test_a_stream_without_numbers_has_gaps_where_it_was_silent():
    t = np.concatenate([np.arange(0.0, 1.0, 0.1), np.arange(2.0, 3.0, 0.1)])
    np.testing.assert_allclose(find_gaps(t), [[0.9, 2.0]])
    assert find_gaps(t[:1]).shape == find_gaps(np.zeros(3)).shape == (0, 2)


def test_a_run_of_a_table_shows_speeds_and_forces_as_measured(tmp_path):
    shown = read_signals(make_run(tmp_path, 50))
    forces, speeds = shown.panels
    table = make_table(50)
    assert [panel.unit for panel in shown.panels] == ["N", "rad/s"]
    np.testing.assert_array_equal(forces.lines["traction"], table.traction_force)
    np.testing.assert_array_equal(speeds.lines["ground"], table.omega_ground)
    assert (shown.state, shown.source) == ("completed", "sim:noise")


def test_a_run_without_samples_or_log_is_named(tmp_path):
    folder = make_run(tmp_path, 20)
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[:300])
    with pytest.raises(DataError, match="holds no samples to plot"):
        read_signals(folder)
    log.unlink()
    with pytest.raises(NotFound, match=r"log\.mcap"):
        read_signals(folder)
