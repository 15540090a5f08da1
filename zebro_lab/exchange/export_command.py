# SPDX-License-Identifier: MIT
"""`zebro-lab export`: a recorded run as tables or as one MCAP file."""

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

from zebro_lab.terminal.messages import say

ExportFormat: TypeAlias = Literal["csv", "parquet", "mcap"]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]

To = Annotated[
    ExportFormat,
    typer.Option(help="Tables, or one MCAP file of legs, frames, track and band for Foxglove."),
]
Out = Annotated[
    Path, typer.Option(metavar="PATH", help="Folder of tables to write; for mcap, the file.")
]


def export(run: RunFolder, out: Out, to: To = "csv") -> None:
    """Export a run as tables (raw samples, leg angles, calibration columns) or as MCAP."""
    if to == "mcap":
        from zebro_lab.exchange.export_mcap_stage import export_mcap

        exported = export_mcap(run, out=out)
        for topic, count in exported.topics.items():
            say(f"{topic}: {count}")
        for line in (*exported.notes, f"wrote {exported.file}"):
            say(line)
        return
    from zebro_lab.exchange.export_stage import export_run

    for file in export_run(run, to=to, out=out):
        say(f"wrote {file}")
