# SPDX-License-Identifier: MIT
"""`zebro-lab export`: a recorded run as tables or as one MCAP file."""

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

ExportFormat: TypeAlias = Literal["csv", "parquet", "mcap"]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]

To = Annotated[
    ExportFormat,
    typer.Option(help="Format: tables (csv, parquet), or one MCAP file for Foxglove."),
]
Out = Annotated[
    Path, typer.Option(metavar="PATH", help="New folder for the tables; for mcap, a new file.")
]


@request_command()
def export(run: RunFolder, out: Out, to: To = "csv", output: Output = TEXT) -> None:
    """Export a run as tables of its samples, or its track and prediction as one MCAP file."""
    if to == "mcap":
        from zebro_lab.exchange.export_mcap_stage import export_mcap

        exported = export_mcap(run, out=out)
        for topic, count in exported.topics.items():
            output.say(f"{topic}: {count} messages")
        output.say(*exported.notes, f"wrote {exported.file}")
        content = {"messages": dict(exported.topics), "notes": list(exported.notes)}
        output.document("export", {**content, "written": [exported.file]})
        return
    from zebro_lab.exchange.export_stage import export_run, unended_notes

    files = list(export_run(run, to=to, out=out))
    notes = list(unended_notes(run))
    output.say(*notes, *(f"wrote {file}" for file in files))
    output.document("export", {"written": files, "notes": notes})
