# SPDX-License-Identifier: MIT
"""`zebro-lab read-off DATA`: read B, C, D and E off slip curves, as the thesis does."""

from typing import TYPE_CHECKING

from zebro_lab.calibration.read_off.request import ReadOffRequest
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from rich.table import Table

    from zebro_lab.calibration.read_off.stage import ReadOffResult

EPILOG = """
Examples:

zebro-lab read-off curve.csv

zebro-lab read-off datasets/rig-sim --out read-off

Section 4-5-1 of the thesis: peak, asymptote, slope at zero slip and slip of the peak give the four
coefficients at each load; from these, least squares find the formula closest to all points, with
standard errors. It is no fit with a posterior: that is calibrate-slip.
"""


@request_command()
def read_off(request: ReadOffRequest, output: Output = TEXT) -> None:
    """Read the Magic Formula's B, C, D and E off slip curves, one set at each load."""
    from zebro_lab.calibration.read_off import stage
    from zebro_lab.terminal.result import print_result

    result = stage.read_off_curves(request)
    reasons = [f"{each.curve.load:.4g} N, {each.side}: {each.reason}"
               for each in result.curves if each.found is None]  # fmt: skip
    parts = [*result.notes, _table(result), *reasons]
    print_result(output.console(), parts, source=result.source, out=request.out)
    content = {
        "folder": request.out,
        "simulated": is_simulated(result.source),
        "slip_definition": str(result.definition),
        "curves": [each.row() for each in result.curves],
        "notes": list(result.notes),
    }
    output.document("read-off", content)


def _table(result: "ReadOffResult") -> "Table":
    """Return a table of the coefficients with standard errors, for curves that gave them."""
    from zebro_lab.terminal.tables import plain_table

    headings = ("Fn [N]", "B [-]", "C [-]", "D [N]", "E [-]", "D/Fn", "peak slip", "misfit [N]")
    title = f"read off, slip definition {result.definition}; standard errors of least squares"
    table = plain_table(title, ("side",), headings, no_wrap=True)
    for each in result.curves:
        if each.found is not None:
            row = each.row()
            table.add_row(
                each.side, f"{each.curve.load:.4g}",
                *(f"{row[name]:.4g} ± {row[f'{name}_error']:.2g}" for name in "BCDE"),
                f"{row['peak_over_load']:.4g}", f"{row['peak_slip']:.4g}", f"{row['misfit_n']:.3g}",
            )  # fmt: skip
    return table
