# SPDX-License-Identifier: MIT
"""`zebro-lab compare A B`: compare calibrations, a calibration and a curve, or runs."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import request_command

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
    from zebro_lab.validation.compare import screen, stage

    done = stage.compare(first, second, out=out, form=form)
    screen.print_compared(output.console(), done, out)
    content = {"folder": out, "simulated": is_simulated(done.comparison.source)}
    output.document("compare", {**content, **screen.compared_document(done)})
