# SPDX-License-Identifier: MIT
"""Options of `zebro-lab read-off`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from zebro_lab.calibration.request import DefinitionName
from zebro_lab.terminal.picture_options import FormatOption


@dataclass(frozen=True)
class ReadOffRequest:
    """Options of `zebro-lab read-off`."""

    data: Annotated[
        tuple[Path, ...],
        Argument(
            metavar="DATA",
            help="A table of a curve, or rig data as for calibrate-slip, whose runs are points.",
        ),
    ]
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("read-off")
    columns: Annotated[
        Path | None,
        Option(metavar="FILE", help="columns.toml to use instead of those beside the tables."),
    ] = None
    slip_definition: Annotated[
        DefinitionName | None,
        Option(help="Definition of the slip ratio to convert to; default: that of the data."),
    ] = None
    form: FormatOption = "png"
