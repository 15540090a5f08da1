# SPDX-License-Identifier: MIT
"""Write `contacts.csv` and `touchdowns.csv` of a walk folder.

Only this module depends on the format of these files.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from model.contact.sequence import ContactState, named_legs
from model.contact.touchdown import Touchdown
from zebro_lab.walk.contacts import WalkContacts

CONTACT_COLUMNS = ("by", "contact", "start", "end", "duration", "cycle", "joined")
"""Columns of `contacts.csv`, in order."""
TOUCHDOWN_COLUMNS = (
    "leg", "turn", "t", "angle", "asked_t", "asked_angle", "late", "liftoff_t", "liftoff_angle",
    "contacts",
)  # fmt: skip
"""Columns of `touchdowns.csv`, in order."""


def write_contacts(file: Path, contacts: WalkContacts) -> None:
    """Write the contact states of a walk as CSV, one row a state, SI.

    Args:
        file: File to write; an existing one is overwritten.
        contacts: Contacts of the walk.
    """
    rows = (
        (contacts.by, f'"{named_legs(state.legs)}"', _number(state.start), _number(state.end),
         _number(state.duration), _cycle_number(contacts, state), str(state.joined))
        for state in contacts.sequence.states
    )  # fmt: skip
    _write(file, CONTACT_COLUMNS, rows)


def _cycle_number(contacts: WalkContacts, state: ContactState) -> str:
    """Return the number of the repeating cycle that a state begins in, "" for the transient.

    Cycles begin with the gait's, and are counted from the one in which the walk begins to repeat.
    """
    cycle = contacts.cycle
    if cycle is None or state.start < cycle.settled:
        return ""
    return str(1 + int((state.start - cycle.settled) / cycle.period + 1e-6))


def write_touchdowns(file: Path, downs: Sequence[Touchdown]) -> None:
    """Write the touchdowns of a walk as CSV, one row a leg and turn, SI; NaN is an empty cell.

    Args:
        file: File to write; an existing one is overwritten.
        downs: The touchdowns.
    """
    rows = (
        (str(each.leg + 1), str(each.turn), _number(each.t), _number(each.angle),
         _number(each.asked_t), _number(each.asked_angle), _number(each.late),
         _number(each.liftoff_t), _number(each.liftoff_angle), str(each.contacts))
        for each in downs
    )  # fmt: skip
    _write(file, TOUCHDOWN_COLUMNS, rows)


def _write(file: Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    with file.open("w", encoding="utf-8", newline="\n") as text:
        text.write(",".join(columns) + "\n")
        text.writelines(",".join(row) + "\n" for row in rows)


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.10g}"
