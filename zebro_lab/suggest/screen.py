# SPDX-License-Identifier: MIT
"""Terminal output of `rig suggest`."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from model.counted import counted
from zebro_lab.files.source_names import is_simulated
from zebro_lab.files.units import unit_symbol
from zebro_lab.suggest.folder import PLAN, Expected, Suggested
from zebro_lab.terminal.tables import plain, plain_table


def print_suggested(console: Console, suggested: Suggested, out: Path) -> None:
    """Print what is expected, the points, what that assumes, and the folder.

    Args:
        console: Console to print to.
        suggested: The suggestion.
        out: Folder that was written.
    """
    if is_simulated(suggested.source):
        console.print(plain(f"calibration of SIMULATED data, source '{suggested.source}'"))
    console.print(expected_table(suggested))
    for line in lines(suggested):
        console.print(plain(line))
    console.print(plain(f"written to {out}; next: zebro-lab rig plan {out / PLAN}"))


def expected_table(suggested: Suggested) -> Table:
    """Return a table of standard deviations now, after the plan and after the suggestion."""
    proposal = suggested.proposal
    headings = (
        "sd now", f"after the plan\nas it is, {_minutes(suggested.plan_seconds)}",
        f"after the\nsuggestion, {_minutes(proposal.seconds)}", "narrower\nthan the plan's",
    )  # fmt: skip
    title = f"expected of plan '{suggested.plan.name}' after {suggested.calibration}"
    table = plain_table(title, ("target",), headings, no_wrap=True)
    for row in suggested.expected:
        sds = (row.sd_now, row.sd_plan, row.sd_suggested)
        less = 100 * (1 - row.sd_suggested / row.sd_plan)
        table.add_row(plain(_named(row)), *(_sd(sd, row) for sd in sds), f"{less:.0f} %")
    return table


def lines(suggested: Suggested) -> list[str]:
    """Return the suggested points, and what the proposal assumes."""
    proposal, points = suggested.proposal, suggested.proposal.plan.points
    slips = ", ".join(
        f"{slip:g}" if count == 1 else f"{slip:g} ({count} times)"
        for slip, count in zip(proposal.slips, proposal.counts, strict=True)
    )
    loads = ", ".join(f"{load:g}" for load in points.loads)
    total = int(proposal.counts.sum()) * len(points.loads)
    return [
        f"{counted(total, 'point')} of {points.duration:g} s, at loads of {loads} N each slips of "
        f"{slips}",
        *suggested.notes,
    ]


def _named(row: Expected) -> str:
    """Return the name of a row: target and part; the part alone of a parameter or a force."""
    return row.part if row.part == row.target or _is_force(row) else f"{row.target} {row.part}"


def _is_force(row: Expected) -> bool:
    """Return whether a row is of a force, whose standard deviations are relative."""
    return row.part.startswith("force@")


def _sd(sd: float, row: Expected) -> str:
    """Format a standard deviation with its unit, the relative one of a force in percent."""
    if _is_force(row):
        return f"{100 * sd:.3g} %"
    symbol = unit_symbol(row.unit)
    return f"{sd:.3g}" if symbol == "-" else f"{sd:.3g} {symbol}"


def _minutes(seconds: float) -> str:
    """Format a time [s] in whole minutes and seconds; below a minute in seconds alone."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
