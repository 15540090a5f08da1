# SPDX-License-Identifier: MIT
"""What a person reads of a walk's contacts: the sequence of a cycle, and touchdowns by leg."""

from collections.abc import Sequence
from itertools import islice

import numpy as np
import pandas as pd
from rich.table import Table

from model.contact.sequence import ContactCycle, ContactState, named_legs
from model.contact.touchdown import Touchdown
from model.counted import counted
from model.robot import N_LEGS
from zebro_lab.terminal.tables import plain_table
from zebro_lab.walk.contacts import WalkContacts

_SHOWN = 12  # states of a walk that does not repeat; `contacts.csv` has all


def contact_lines(contacts: WalkContacts) -> list[str]:
    """Format contacts as lines: what decides contact, the cycle of states, joined states.

    Without a cycle the first `_SHOWN` states are listed, and why there is none.
    """
    sequence, cycle = contacts.sequence, contacts.cycle
    lines = [f"contact states by {contacts.rule}:"]
    if cycle is not None:
        lines.append(f"  {cycle}")
        lines.append(
            f"  a cycle of {cycle.period:.4g} s, which repeats from {cycle.settled:.2f} s on, "
            f"times within {1000 * float(cycle.spread.max()):.0f} ms in {cycle.cycles} cycles"
        )
    else:
        shown = " → ".join(_with_start(state) for state in islice(sequence.states, _SHOWN))
        more = len(sequence.states) - _SHOWN
        lines.append(f"  {shown}" + (f" → … ({counted(more, 'more state')})" if more > 0 else ""))
        lines.append(f"  {_why_no_cycle(contacts)}")
    if sequence.joined:
        lines.append(
            f"  states shorter than {1000 * sequence.least:g} ms are joined to the next: "
            f"{sequence.joined}, {sequence.joined_time:.3f} s in all"
        )
    return lines


def _with_start(state: ContactState) -> str:
    """Format the legs of a contact state, and the time at which it begins [s]."""
    return f"{named_legs(state.legs)} ({state.start:.2f} s)"


def _why_no_cycle(contacts: WalkContacts) -> str:
    """Say why the contact states have no cycle."""
    if contacts.period is None:
        return "these leg angles have no cycle that repeats"
    if len(contacts.sequence.states) == 1:
        return "the legs on the ground never change"
    return (
        f"the last two cycles of {contacts.period:.4g} s do not repeat within "
        f"{1000 * contacts.tolerance:.0f} ms; walk longer; on uneven ground they may never"
    )


def touchdown_table(contacts: WalkContacts) -> Table:
    """Return a table of touchdowns, a row per leg: means and standard deviations."""
    numbers = ("touchdowns", "missed", "angle\n[deg]", "sd\n[deg]", "asked\n[deg]", "late\n[ms]",
               "sd\n[ms]", "lift-off\n[deg]", "again\ndown")  # fmt: skip
    title = f"touchdowns by {contacts.rule}"
    table = plain_table(title, ("leg",), numbers)
    for leg in range(N_LEGS):
        row = touchdown_summary([each for each in contacts.touchdowns if each.leg == leg])
        cells = (
            f"{row['touchdowns']}", f"{row['missed']}",
            *(_cell(row[key], scale) for key, scale in _SHOWN_MEANS), f"{row['again']}",
        )  # fmt: skip
        table.add_row(str(leg + 1), *cells)
    return table


_SHOWN_MEANS = (
    ("angle_rad", 180 / np.pi), ("angle_sd_rad", 180 / np.pi), ("asked_angle_rad", 180 / np.pi),
    ("late_s", 1000.0), ("late_sd_s", 1000.0), ("liftoff_angle_rad", 180 / np.pi),
)  # fmt: skip


def _cell(value: float | None, scale: float) -> str:
    """Format a value times `scale` with two decimals; `-` for None."""
    return "-" if value is None else f"{scale * value:.2f}"


def touchdown_summary(downs: Sequence[Touchdown]) -> dict[str, float | None]:
    """Summarise touchdowns of a leg: counts of turns, means and standard deviations [rad, s].

    A mean is None if no value is known, a standard deviation if fewer than two are. Touchdowns
    after the first in the same turn are counted as `again`.

    Args:
        downs: Touchdowns of one leg; turns without contact count as missed.
    """
    rows = [(each.angle, each.asked_angle, each.late, each.liftoff_angle) for each in downs]
    names = ["angle_rad", "asked_angle_rad", "late_s", "liftoff_angle_rad"]
    table = pd.DataFrame(rows, columns=names, dtype=float)
    mean, spread = table.mean().to_numpy(float), table.std().to_numpy(float)
    values = dict(zip(names, mean, strict=True))
    values |= {"angle_sd_rad": spread[0], "late_sd_s": spread[2]}
    return {
        "touchdowns": sum(each.contacts > 0 for each in downs),
        "missed": sum(each.contacts == 0 for each in downs),
        "again": sum(max(each.contacts - 1, 0) for each in downs),
        **{name: None if np.isnan(value) else float(value) for name, value in values.items()},
    }


def contact_document(contacts: WalkContacts) -> dict[str, object]:
    """Return contacts and touchdowns for `--json`; keys end in the unit."""
    return {
        "least_s": contacts.sequence.least,
        "tolerance_s": contacts.tolerance,
        "rules": [{
            "by": contacts.by,
            "states": len(contacts.sequence.states),
            "joined": contacts.sequence.joined,
            "joined_s": contacts.sequence.joined_time,
            "cycle": None if contacts.cycle is None else _cycle_document(contacts.cycle),
        }],
        "touchdowns": [
            {"leg": leg + 1,
             **touchdown_summary([each for each in contacts.touchdowns if each.leg == leg])}
            for leg in range(N_LEGS)
        ],
    }  # fmt: skip


def _cycle_document(cycle: ContactCycle) -> dict[str, object]:
    """Return a cycle of contact states for `--json`; keys end in the unit."""
    return {
        "period_s": cycle.period,
        "contacts": [named_legs(legs) for legs in cycle.states],
        "begins_s": cycle.begins,
        "spread_s": cycle.spread,
        "settled_s": cycle.settled,
        "cycles": cycle.cycles,
    }
