# SPDX-License-Identifier: MIT
import csv

import numpy as np

from model.contact.sequence import contact_cycle, contact_states
from model.contact.touchdown import Touchdown
from zebro_lab.walk.contact_files import (
    CONTACT_COLUMNS,
    TOUCHDOWN_COLUMNS,
    write_contacts,
    write_touchdowns,
)
from zebro_lab.walk.contacts import WalkContacts

T = np.arange(600, dtype=float) * 0.01


def test_states_are_written_with_the_cycle_that_they_begin_in(tmp_path):
    contact = (T % 2 < 1)[:, None] == np.isin(np.arange(6), (0, 3, 4))
    sequence = contact_states(T, contact)
    cycle = contact_cycle(sequence, 2.0, tolerance=0.02)
    write_contacts(tmp_path / "c.csv", WalkContacts("force", sequence, cycle, 2.0, 0.02, ()))
    with (tmp_path / "c.csv").open(newline="") as text:
        rows = list(csv.reader(text))
    assert tuple(rows[0]) == CONTACT_COLUMNS
    assert rows[1] == ["force", "{1,4,5}", "0", "1", "1", "", "0"]
    assert rows[2] == ["force", "{2,3,6}", "1", "2", "1", "1", "0"]
    assert [row[5] for row in rows[1:]] == ["", "1", "1", "2", "2", "3"]


def test_a_touchdown_that_there_was_not_is_empty(tmp_path):
    nan = float("nan")
    rows = [Touchdown(2, 1, 1.5, 0.5, 1.25, 0.75, nan, nan, 1),
            Touchdown(2, 2, nan, nan, 3.25, 0.75, nan, nan, 0)]  # fmt: skip
    write_touchdowns(tmp_path / "t.csv", rows)
    assert (tmp_path / "t.csv").read_text().splitlines() == [
        ",".join(TOUCHDOWN_COLUMNS),
        "3,1,1.5,0.5,1.25,0.75,0.25,,,1",
        "3,2,,,3.25,0.75,,,,0",
    ]
