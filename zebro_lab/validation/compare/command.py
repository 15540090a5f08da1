# SPDX-License-Identifier: MIT
"""`zebro-lab compare A B`: compare calibrations, a calibration and a curve, or runs."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.validation.compare.request import CompareRequest

if TYPE_CHECKING:
    from rich.table import Table

    from zebro_lab.validation.compare.stage import Compared

EPILOG = """
Examples:

zebro-lab compare calibration-tiles calibration-carpet

zebro-lab compare calibration thesis --out against-thesis

zebro-lab compare calibration magic:34.34,1.564,0.3798,0:material

zebro-lab compare calibration published.csv

zebro-lab compare data/RUN1 data/RUN2 --out tiles-carpet

Of calibrations the curve is compared at loads that both were tested at, and legs and floor if both
were fitted to walks. A curve is compared at the tested loads, and judged by the band that holds
90 % of whole curves of the calibration: thesis; coulomb:MU; magic:B,C,D,E with D over load, or with
@LOAD in newtons, and the slip definition behind a colon; or a table with slip_ratio,
slip_definition and traction_over_load, or traction_force and normal_force. Of runs speed, yaw rate
and curvature, tracked and predicted. Probabilities take the two for independent; a track's errors
are taken for independent from pose to pose.
"""


@request_command()
def compare(request: CompareRequest, output: Output = TEXT) -> None:
    """Compare calibrations, a calibration and a curve, or runs: overlay, list differences."""
    from rich.text import Text

    from zebro_lab.validation.compare import stage

    done = stage.compare(request)
    console = output.console()
    if is_simulated(done.comparison.source):
        console.print(plain(f"SIMULATED: {done.comparison.source}"))
    console.print(_table(done))
    for note in done.comparison.notes:
        console.print(plain(note))
    console.print(Text(f"\nwritten to {request.out}"))
    simulated = is_simulated(done.comparison.source)
    content: dict[str, Any] = {
        "folder": request.out,
        "simulated": simulated,
        "names": done.comparison.names,
    }
    notes = list(done.comparison.notes)
    if done.comparison.place is not None:
        content["place"] = asdict(done.comparison.place)
    output.document("compare", {**content, "quantities": _quantities(done), "notes": notes})


def _quantities(done: "Compared") -> list[dict[str, object]]:
    """Return medians and 90 % intervals of both and of their difference, for `--json`."""
    found = []
    for quantity, apart in zip(done.comparison.quantities, done.differences, strict=True):
        values = {
            "first": quantity.quantiles(0),
            "second": quantity.quantiles(1),
            "difference": (apart.median, apart.low, apart.high),
        }
        intervals = {
            name: dict(zip(("median", "low", "high"), map(float, each), strict=True))
            for name, each in values.items()
        }
        found.append(
            {
                "name": quantity.name,
                "unit": quantity.unit,
                **intervals,
                "probability_second_larger": float(apart.probability),
            }
        )
    return found


def _table(done: "Compared") -> "Table":
    from rich import box
    from rich.table import Table

    one, other = done.comparison.names
    table = Table(
        title=plain(f"{other} minus {one}: medians, 90 % intervals"),
        box=box.SIMPLE,
        title_justify="left",
    )
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
