# SPDX-License-Identifier: MIT
"""Bars of contact and labels of contact states stand where the legs are on the ground."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from model.contact.sequence import contact_states
from zebro_lab.plots.walk_contacts import contact_states_chart, gantt, stances

T = np.arange(600, dtype=float) * 0.01


def drawn(walked, span, step=1.0):
    """Return the chart of tripods that change every so many seconds."""
    contact = ((T // step) % 2 == 0)[:, None] == np.isin(np.arange(6), (0, 3, 4))
    path = replace(walked.part(np.zeros(len(T), dtype=int)), t=T, contact=contact)
    return contact_states_chart(path, contact_states(T, contact).states, span, title="A walk")


def test_the_legs_of_each_state_are_above_its_bars(walked):
    (axes,) = drawn(walked, (2.0, 5.0)).axes
    texts = [(text.get_text(), text.get_position()[0]) for text in axes.texts]
    assert texts == [("{1,4,5}", 2.5), ("{2,3,6}", 3.5), ("{1,4,5}", 4.5)]
    assert len(axes.collections) == 6
    assert axes.get_xlim() == (2.0, 5.0)
    colours = [str(bars.get_facecolor()) for bars in axes.collections]
    assert len(set(colours[::2])) == len(set(colours[1::2])) == 1
    assert colours[0] != colours[1]


@given(arrays(bool, st.integers(1, 30)))
def test_stances_are_where_the_contact_is(contact):
    t = np.arange(float(len(contact)))
    found = np.zeros(len(contact), dtype=bool)
    for start, end in stances(t, contact):
        found[(t >= start) & ((t < end) | ((t == t[-1]) & (end == t[-1]) & contact[-1]))] = True
    np.testing.assert_array_equal(found, contact)


def test_bars_of_contact_are_the_stances_of_each_leg(walked):
    (axes,) = gantt(walked, title="A walk").axes
    assert len(axes.collections) == 6
    labels = axes.get_legend_handles_labels()[1]
    assert set(labels) == {"left leg on the ground", "right leg on the ground"}
    for leg, bars in enumerate(axes.collections):
        boxes = [path.get_extents() for path in bars.get_paths()]
        drawn = [(box.x0, box.x1) for box in boxes]
        np.testing.assert_allclose(drawn, stances(walked.t, walked.contact[:, leg]))
        assert all(box.y0 < leg + 1 < box.y1 for box in boxes)
    low, high = axes.get_ylim()
    assert low > high  # leg 1 on top
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert names[0] == "1  left front"
    assert axes.get_xlabel() == "time [s]"
    np.testing.assert_allclose(axes.get_xlim(), (walked.t[0] - 0.04, walked.t[-1] + 0.04))
