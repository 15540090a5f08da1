# SPDX-License-Identifier: MIT
import numpy as np

from model.contact.sequence import contact_states
from zebro_lab.plots.walk_contacts import DrawnContacts, contact_states_chart

T = np.arange(600, dtype=float) * 0.01


def drawn(rule, step=1.0):
    contact = ((T // step) % 2 == 0)[:, None] == np.isin(np.arange(6), (0, 3, 4))
    return DrawnContacts(rule, T, contact, contact_states(T, contact).states)


def test_each_rule_has_a_panel_with_the_legs_of_each_state_above_its_bars():
    figure = contact_states_chart([drawn("detection"), drawn("force")], (2.0, 5.0), title="A walk")
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["by detection", "by force"]
    for axes in figure.axes:
        texts = [(text.get_text(), text.get_position()[0]) for text in axes.texts]
        assert texts == [("{1,4,5}", 2.5), ("{2,3,6}", 3.5), ("{1,4,5}", 4.5)]
        assert len(axes.collections) == 6
        assert axes.get_xlim() == (2.0, 5.0)
        colours = [str(bars.get_facecolor()) for bars in axes.collections]
        assert len(set(colours[::2])) == len(set(colours[1::2])) == 1
        assert colours[0] != colours[1]


def test_states_too_narrow_for_their_label_have_none():
    figure = contact_states_chart([drawn("force", step=0.05)], (0.0, 5.99), title="A walk")
    assert len(figure.axes[0].texts) == 0
    assert len(figure.axes[0].lines) > 50
