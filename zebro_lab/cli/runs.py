# SPDX-License-Identifier: MIT
"""`zebro-lab runs`, `exclude` and `export`: what has been recorded, and what of it counts."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say


class ExportFormat(StrEnum):
    """Forms of exported runs."""

    CSV = "csv"
    PARQUET = "parquet"
    MCAP = "mcap"


DataDir = Annotated[Path, typer.Argument(metavar="DATA", help="Folder of run folders.")]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
Why = Annotated[str | None, typer.Option(help="Reason, kept with the run and those of before.")]
Undo = Annotated[bool, typer.Option("--undo", help="Take the run in again.")]

To = Annotated[
    ExportFormat,
    typer.Option(help="Tables, or one MCAP file of legs, frames, track and band for Foxglove."),
]
Out = Annotated[
    Path, typer.Option(metavar="PATH", help="Folder of tables to make; of mcap, the file.")
]


def runs(data: DataDir) -> None:
    """List recorded runs: how each ended, what it holds and where it comes from."""
    from zebro_lab.stages.runs import list_runs

    listed = list_runs(data)
    for run in listed:
        say(
            f"{run.name}  {run.state}  {run.duration}  {run.samples}  "
            f"{'SIMULATED ' if run.source.startswith('sim:') else ''}{run.source}"
        )
    say(f"{len(listed)} run{'s' * (len(listed) != 1)} in {data}")


def exclude(run: RunFolder, why: Why = None, undo: Undo = False) -> None:
    """Leave a run out of every calibration, and keep it; or take it in again."""
    from zebro_lab.run_exclusion import exclude_run, take_in_again

    if undo:
        take_in_again(run, why=why)
        say(f"{run.name} counts again from now on")
        return
    if why is None:
        raise typer.BadParameter("needed: the reason, kept with the run", param_hint="'--why'")
    manifest = exclude_run(run, why=why)
    say(f"{run.name} is left out from now on: {(manifest.excluded or {})['why']}")


def export(run: RunFolder, out: Out, to: To = ExportFormat.CSV) -> None:
    """Write a run as tables: raw samples, leg angles, the columns of a calibration; or as MCAP."""
    if to is ExportFormat.MCAP:
        from zebro_lab.stages.export_mcap import export_mcap

        exported = export_mcap(run, out=out)
        for topic, count in exported.topics.items():
            say(f"{topic}: {count}")
        for line in (*exported.notes, f"wrote {exported.file}"):
            say(line)
        return
    from zebro_lab.stages.export import export_run

    for file in export_run(run, to=to.value, out=out):
        say(f"wrote {file}")
