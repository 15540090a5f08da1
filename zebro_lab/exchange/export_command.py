# SPDX-License-Identifier: MIT
"""`zebro-lab export`: a recorded run as tables."""

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

ExportFormat: TypeAlias = Literal["csv", "parquet"]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
To = Annotated[ExportFormat, typer.Option(help="Format of the tables.")]
Out = Annotated[Path, typer.Option(metavar="PATH", help="New folder for the tables.")]


@request_command()
def export(run: RunFolder, out: Out, to: To = "csv", output: Output = TEXT) -> None:
    """Export a run as tables of its samples."""
    from zebro_lab.exchange.export_stage import export_run

    files, notes = export_run(run, to=to, out=out)
    output.say(*notes, *(f"wrote {file}" for file in files))
    output.document("export", {"written": list(files), "notes": list(notes)})
