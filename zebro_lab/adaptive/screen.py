# SPDX-License-Identifier: MIT
"""Lines and table of an adaptive experiment, for the terminal and for JSON."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from model.counted import counted
from zebro_lab.adaptive.rounds import Round
from zebro_lab.adaptive.wanted import Wanted
from zebro_lab.suggest.target_text import ForceText
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.tables import plain_table


def told(round_: Round, wanted: Sequence[Wanted]) -> str:
    """Return a line on a finished round: its points, and the interval of each target."""
    widths = "; ".join(_width(each, round_) for each in wanted)
    doubt = f"; the fit: {round_.doubt}" if round_.doubt else ""
    return (
        f"round {round_.number}: {counted(round_.points, 'point')} in {round_.seconds:.0f} s; "
        f"90 % intervals: {widths}{doubt}"
    )


def _width(wanted: Wanted, round_: Round) -> str:
    shown = _number(wanted, round_.half_widths[wanted.text])
    aim = "" if wanted.half_width is None else f" (wanted {_number(wanted, wanted.half_width)})"
    return f"{wanted.text} {shown}{aim}"


def _number(wanted: Wanted, width: float) -> str:
    if math.isnan(width):
        return "not known"
    if isinstance(wanted.target, ForceText):
        return f"± {100 * width:.3g} %"
    return f"± {width:.3g}"


def rounds_table(rounds: Sequence[Round], wanted: Sequence[Wanted]) -> Table:
    """Return a table of rounds with the half widths of 90 % intervals after each."""
    headings = ("points", "refused", "seconds in all", *(each.text for each in wanted))
    title = "half widths of 90 % intervals, of all rounds so far fitted together"
    table = plain_table(title, ("round",), headings, no_wrap=True)
    seconds = 0.0
    for each in rounds:
        seconds += each.seconds
        widths = (_number(one, each.half_widths[one.text]) for one in wanted)
        table.add_row(
            plain(f"{each.number}"), f"{each.points}", f"{each.refused}", f"{seconds:.0f}", *widths
        )
    return table


def in_numbers(rounds: Sequence[Round]) -> list[Mapping[str, Any]]:
    """Return the rounds for a JSON document; a half width that is not known is None."""
    return [
        {
            "round": each.number,
            "points": each.points,
            "refused": each.refused,
            "seconds": each.seconds,
            "half_widths": {
                name: None if math.isnan(width) else width
                for name, width in each.half_widths.items()
            },
            "doubt": each.doubt,
        }
        for each in rounds
    ]
