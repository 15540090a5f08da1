# SPDX-License-Identifier: MIT
"""`zebro-lab runs` and `exclude`: list runs, and leave runs out of calibrations."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say
from zebro_lab.terminal.request_command import request_command

DataDir = Annotated[Path, typer.Argument(metavar="DATA", help="Folder to search for run folders.")]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
Why = Annotated[str | None, typer.Option(help="Reason, kept in run.json; required without --undo.")]
Undo = Annotated[bool, typer.Option("--undo", help="Undo the exclusion of the run.")]


@request_command()
def runs(data: DataDir) -> None:
    """List recorded runs with their state, duration, samples and source."""
    from zebro_lab.runs.stage import list_runs

    listed = list_runs(data)
    for run in listed:
        say(
            f"{run.name}  {run.state}  {run.duration}  {run.samples}  "
            f"{'SIMULATED ' if run.source.startswith('sim:') else ''}{run.source}"
        )
    say(f"{len(listed)} run{'s' * (len(listed) != 1)} in {data}")


@request_command()
def exclude(run: RunFolder, why: Why = None, undo: Undo = False) -> None:
    """Exclude a run from every later calibration, or undo that; its data stay."""
    from zebro_lab.runs.exclusion import exclude_run, take_in_again
    from zebro_lab.runs.folder import require_ended

    require_ended(run)
    if undo:
        take_in_again(run, why=why)
        say(f"{run.name} is no longer excluded from calibrations")
        return
    if why is None:
        raise typer.BadParameter(
            "missing; state why the run is excluded, for run.json", param_hint="'--why'"
        )
    manifest = exclude_run(run, why=why)
    say(f"{run.name} is excluded from calibrations: {(manifest.excluded or {})['why']}")
