# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np

from model.contact.sequence import contact_states
from zebro_lab.plots.walk_contacts import contact_states_chart

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
