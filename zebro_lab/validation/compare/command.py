# SPDX-License-Identifier: MIT
"""`zebro-lab compare A B`: compare calibrations, a calibration and a curve, or runs."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from rich.table import Table

    from zebro_lab.validation.compare.stage import Compared

EPILOG = """
Examples:

zebro-lab compare calibration-tiles calibration-carpet

zebro-lab compare calibration thesis --out against-thesis

zebro-lab compare data/RUN1 data/RUN2 --out tiles-carpet

A curve is thesis; coulomb:MU; or a table with slip_ratio, slip_definition, traction_force and
normal_force. Probabilities take the two for independent.
"""
_FIRST = "Calibration folder, run folder, or a curve: thesis, coulomb:MU or a table."


@request_command()
def compare(
    first: Annotated[Path, Argument(metavar="A", help=_FIRST)],
    second: Annotated[
        Path, Argument(metavar="B", help="Second of the same kind; a curve beside a calibration.")
    ],
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("comparison"),
    form: FormatOption = "png",
    output: Output = TEXT,
) -> None:
    """Compare calibrations, a calibration and a curve, or runs: overlay, list differences."""
    from zebro_lab.validation.compare import stage

    done = stage.compare(first, second, out=out, form=form)
    compared = done.comparison
    simulated = is_simulated(compared.source)
    console = output.console()
    if simulated:
        console.print(plain(f"SIMULATED: {compared.source}"))
    console.print(_table(done))
    for line in (*compared.notes, f"\nwritten to {out}"):
        console.print(plain(line))
    place = {} if compared.place is None else {"place": asdict(compared.place)}
    content: dict[str, Any] = {
        "folder": out,
        "simulated": simulated,
        "names": compared.names,
        **place,
        "quantities": _quantities(done),
        "notes": compared.notes,
    }
    output.document("compare", content)


def _quantities(done: "Compared") -> list[dict[str, object]]:
    """Return medians and 90 % intervals of both and of their difference, for `--json`."""
    keys = ("median", "low", "high")
    return [
        {
            "name": quantity.name,
            "unit": quantity.unit,
            "first": dict(zip(keys, quantity.quantiles(0), strict=True)),
            "second": dict(zip(keys, quantity.quantiles(1), strict=True)),
            "difference": {key: getattr(apart, key) for key in keys},
            "probability_second_larger": apart.probability,
        }
        for quantity, apart in zip(done.comparison.quantities, done.differences, strict=True)
    ]


def _table(done: "Compared") -> "Table":
    from rich import box
    from rich.table import Table

    one, other = done.comparison.names
    title = plain(f"{other} minus {one}: medians, 90 % intervals")
    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    table.add_column("quantity")
    for name in (one, other, "difference", "unit", f"P({other} is larger)"):
        table.add_column(plain(name), justify="right")
    for quantity, apart in zip(done.comparison.quantities, done.differences, strict=True):
        both = [_spelled(*quantity.quantiles(which)) for which in (0, 1)]
        table.add_row(
            quantity.name, *both, _spelled(apart.median, apart.low, apart.high), quantity.unit,
            f"{apart.probability:.1%}" + (" *" if apart.clear else ""),
        )  # fmt: skip
    table.caption = "*: zero lies outside the difference's 90 % interval"
    return table


def _spelled(median: float, low: float, high: float) -> str:
    if low == high:  # of a curve without uncertainty
        return f"{median:.4g}"
    return f"{median:.4g} ({low:.4g} … {high:.4g})"
