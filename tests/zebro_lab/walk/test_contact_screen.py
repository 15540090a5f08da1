# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.contact.sequence import contact_cycle, contact_states
from model.contact.touchdown import Touchdown
from zebro_lab.walk.contact_screen import (
    contact_document,
    contact_lines,
    touchdown_summary,
    touchdown_table,
)
from zebro_lab.walk.contacts import WalkContacts

T = np.arange(600, dtype=float) * 0.01
TRIPOD = np.isin(np.arange(6), (0, 3, 4))


def contacts_of(contact, *, period: float | None = 2.0, downs=()):
    sequence = contact_states(T, contact, least=0.03)
    cycle = None if period is None else contact_cycle(sequence, period, tolerance=0.02)
    return WalkContacts("force", sequence, cycle, period, 0.02, tuple(downs))


def stepping(seconds=1.0):
    """Return contacts of tripods that change every so many seconds."""
    return ((T // seconds) % 2 == 0)[:, None] == TRIPOD


def down(leg, t, angle, asked=1.0, *, contacts=1):
    return Touchdown(leg, 0, t, angle, asked, 0.8, t + 1, 2.0, contacts)


def test_the_sequence_of_a_cycle_is_said_with_its_times_and_what_was_joined():
    contact = stepping()
    contact[150, 0] ^= True
    text = "\n".join(contact_lines(contacts_of(contact)))
    for part in ("by force on the legs", "{2,3,6} → {1,4,5} (0.00 s) → {2,3,6} (1.00 s)",
                 "a cycle of 2 s, which repeats from 1.00 s", "30 ms", "1, 0.010 s"):  # fmt: skip
        assert part in text


@pytest.mark.parametrize(
    ("contact", "period", "why"),
    [
        (stepping(0.7), 2.0, "do not repeat within 20 ms"),
        (np.ones((600, 6), dtype=bool), 2.0, "never change"),
        (stepping(0.1), None, "no cycle that repeats"),
    ],
)
def test_where_nothing_repeats_the_states_are_listed_and_it_is_said_why(contact, period, why):
    _, states, reason = contact_lines(contacts_of(contact, period=period))
    assert states.startswith("  {1,")
    assert ("(48 more states)" in states) == (period is None)
    assert why in reason


def test_touchdowns_are_summarised_by_mean_and_spread():
    rows = [down(0, 1.1, 0.9), down(0, 1.3, 1.1, contacts=3), down(0, np.nan, np.nan, contacts=0)]
    summary = touchdown_summary(rows)
    assert summary["touchdowns"] == 2
    assert summary["missed"] == 1
    assert summary["again"] == 2
    assert summary["angle_rad"] == pytest.approx(1.0)
    assert summary["angle_sd_rad"] == pytest.approx(np.std([0.9, 1.1], ddof=1))
    assert summary["late_s"] == pytest.approx(0.2)
    assert touchdown_summary([])["angle_rad"] is None


def test_the_table_has_a_row_per_leg_and_the_document_every_leg():
    contacts = contacts_of(stepping(), downs=[down(2, 1.1, np.radians(60.0))])
    table = touchdown_table(contacts)
    angles = list(table.columns[3].cells)
    assert angles == ["-", "-", "60.00", "-", "-", "-"]
    (rule,) = contact_document(contacts)["rules"]
    assert (rule["by"], rule["states"], rule["joined"]) == ("force", 6, 0)
    assert rule["cycle"]["contacts"] == ["{1,4,5}", "{2,3,6}"]
    assert rule["cycle"]["begins_s"] == pytest.approx([0.0, 1.0])
