# SPDX-License-Identifier: MIT
"""Terminal output of `compare`: medians, intervals, the probability that the second is larger."""

from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.table import Table

from zebro_lab.terminal.result import print_result
from zebro_lab.terminal.tables import plain_table
from zebro_lab.validation.compare.stage import Compared


def print_compared(console: Console, done: Compared, out: Path) -> None:
    """Print the table of quantities, notes and the folder.

    Args:
        console: Console to print to.
        done: The finished comparison.
        out: Folder that was written.
    """
    compared = done.comparison
    print_result(console, [_table(done), *compared.notes], source=compared.source, out=out)


def compared_document(done: Compared) -> dict[str, object]:
    """Return names, notes, and medians and 90 % intervals of both and of their difference.

    `place`, where a given curve lies in a calibration's band, is there only for such a curve.
    """
    compared, keys = done.comparison, ("median", "low", "high")
    quantities = [
        {
            "name": quantity.name,
            "unit": quantity.unit,
            "first": dict(zip(keys, quantity.quantiles(0), strict=True)),
            "second": dict(zip(keys, quantity.quantiles(1), strict=True)),
            "difference": {key: getattr(apart, key) for key in keys},
            "probability_second_larger": apart.probability,
        }
        for quantity, apart in done.rows
    ]
    place = {} if compared.place is None else {"place": asdict(compared.place)}
    return {"names": compared.names, **place, "quantities": quantities, "notes": compared.notes}


def _table(done: Compared) -> Table:
    """Return a table of medians, their difference, and the probability that the second is larger.

    A star marks differences whose 90 % interval does not hold zero.
    """
    one, other = done.comparison.names
    title = f"{other} minus {one}: medians, 90 % intervals"
    numbers = (one, other, "difference", "unit", f"P({other} is larger)")
    table = plain_table(title, ("quantity",), numbers, fold=True)
    for quantity, apart in done.rows:
        both = [_spelled(*quantity.quantiles(which)) for which in (0, 1)]
        table.add_row(
            quantity.name, *both, _spelled(apart.median, apart.low, apart.high), quantity.unit,
            f"{apart.probability:.1%}" + (" *" if apart.clear else ""),
        )  # fmt: skip
    table.caption = "*: zero lies outside the difference's 90 % interval"
    return table


def _spelled(median: float, low: float, high: float) -> str:
    """Format a median with its interval; without an interval if that has no width."""
    if low == high:  # of a curve without uncertainty
        return f"{median:.4g}"
    return f"{median:.4g} ({low:.4g} … {high:.4g})"
