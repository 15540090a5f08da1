# SPDX-License-Identifier: MIT
"""The picture of a run shows every stream, loses no spike, and marks gaps and events."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from support.watchers import Onlooker
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import record
from zebro_lab.runs.exclusion import exclude_run
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.pictures import extremes, raw_streams
from zebro_lab.runs.plot_stage import plot_run
from zebro_lab.runs.signals import Event, Panel, RunSignals, find_gaps, read_signals
from zebro_lab.runs.slip_rig_decoding import averages_around

T = np.arange(0.0, 10.0, 0.01)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Return a run of all devices, two seconds long."""
    data = tmp_path_factory.mktemp("runs")
    request = RecordRequest("all", data, zebro="sim", imus=("sim",), rig="sim", duration=2.0)
    return record(request, Onlooker()).folder


def signals(events=(), gaps=(), simulated=True):
    panel = Panel("legs: angles", "rad", T, {"leg 1": np.sin(T)}, simulated,
                  np.array(gaps, dtype=float).reshape(-1, 2))  # fmt: skip
    source = "sim:zebro" if simulated else "real"
    return RunSignals("run", "completed", source, (panel,), tuple(events))


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


def test_a_picture_stands_beside_its_run_and_says_how_that_ended(recorded, tmp_path):
    drawn = plot_run(recorded)
    assert drawn.file == recorded.with_name(f"{recorded.name}.png")
    assert drawn.file.read_bytes().startswith(b"\x89PNG")
    exclude_run(recorded, why="belt came off")
    named = plot_run(recorded, out=tmp_path / "all.png")
    assert named.signals.state == "excluded: belt came off"


def test_what_is_simulated_says_so_in_titles_and_what_is_not_does_not():
    for simulated in (True, False):
        figure = raw_streams(signals(simulated=simulated))
        titles = [figure.get_suptitle(), *(axes.get_title(loc="left") for axes in figure.axes)]
        assert all(("simulated" in title) == simulated for title in titles)


def test_gaps_are_shaded_and_no_line_crosses_them():
    figure = raw_streams(signals(gaps=[(2.0, 3.005), (5.0, 5.505)]))
    (axes,) = figure.axes
    assert "2 gaps" in axes.get_title(loc="left")
    (line,) = axes.get_lines()
    t, value = line.get_data()
    assert np.isnan(value[np.isin(t, [2.5025, 5.2525])]).all()
    assert len(axes.collections[0].get_paths()) == 2


def test_of_many_events_each_kind_is_listed_and_the_rest_counted():
    lost = [Event(0.1 * i, "legs: 1 samples lost", True) for i in range(1, 60)]
    silent = Event(8.0, "legs: silent", True)
    events = [Event(0.0, "began", False), *lost, silent, Event(9.0, "ended", False)]
    listing, panel = raw_streams(signals(events)).axes
    texts = [text.get_text() for text in listing.texts]
    assert {"began", "legs: silent", "ended"} <= set(texts)
    assert f"{len(events) - len(texts)} more" in listing.get_title(loc="left")
    assert len(panel.get_lines()) == 1 + len(lost) + 1


@given(arrays(float, st.integers(1, 3000), elements=st.floats(-1e6, 1e6)), st.integers(1, 200))
def test_a_thinned_curve_keeps_its_extremes_and_its_order(values, columns):
    t = np.arange(len(values), dtype=float)
    thin_t, thin = extremes(t, values, columns)
    assert (thin.min(), thin.max()) == (values.min(), values.max())
    assert np.all(np.diff(thin_t) >= 0)
    assert np.array_equal(thin, values[thin_t.astype(int)])


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


def test_what_cannot_be_drawn_is_named(recorded, tmp_path):
    with pytest.raises(SettingsError, match=r"FILE\.png"):
        plot_run(recorded, out=tmp_path / "picture.pdf")
    with pytest.raises(NotFound, match="no such folder"):
        plot_run(recorded, out=tmp_path / "no" / "picture.png")
    with pytest.raises(NotFound, match="no run folder"):
        plot_run(tmp_path)
