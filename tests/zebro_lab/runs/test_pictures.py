# SPDX-License-Identifier: MIT
"""The picture of a run shows every stream, loses no spike, and marks gaps and events."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from zebro_lab.runs.pictures import extremes, raw_streams
from zebro_lab.runs.signals import Event, Panel, RunSignals

T = np.arange(0.0, 10.0, 0.01)


def signals(events=(), gaps=(), simulated=True):
    panel = Panel("legs: angles", "rad", T, {"leg 1": np.sin(T)}, simulated,
                  np.array(gaps, dtype=float).reshape(-1, 2))  # fmt: skip
    source = "sim:zebro" if simulated else "real"
    return RunSignals("run", "completed", source, (panel,), tuple(events))


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


def test_times_to_mark_are_named_and_drawn_in_every_panel():
    figure = raw_streams(signals(), at=[1.5, 4.0])
    for axes in figure.axes:
        assert [line.get_xdata()[0] for line in axes.lines if line.get_color() == "black"] == [
            1.5, 4.0,
        ]  # fmt: skip
        assert [text.get_text() for text in axes.texts] == ["1.5 s", "4 s"]
