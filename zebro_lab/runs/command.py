# SPDX-License-Identifier: MIT
"""`zebro-lab runs` and `exclude`: list runs, and leave runs out of calibrations."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from zebro_lab.runs.manifest import RunManifest

DataDir = Annotated[Path, typer.Argument(metavar="DATA", help="Folder to search for run folders.")]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
Why = Annotated[str | None, typer.Option(help="Reason, kept in run.json; required without --undo.")]
Undo = Annotated[bool, typer.Option("--undo", help="Undo the exclusion of the run.")]


@request_command()
def runs(data: DataDir, output: Output = TEXT) -> None:
    """List recorded runs with their state, duration, samples and source."""
    from zebro_lab.runs.stage import list_runs

    listed = list_runs(data)
    for run in listed:
        output.say(
            f"{run.name}  {run.state}  {run.duration}  {run.samples}  "
            f"{'SIMULATED ' if run.source.startswith('sim:') else ''}{run.source}"
        )
    output.say(f"{len(listed)} run{'s' * (len(listed) != 1)} in {data}")
    simulated = any("sim:" in run.source for run in listed)
    output.document("runs", {"simulated": simulated, "runs": [asdict(run) for run in listed]})


@request_command()
def exclude(run: RunFolder, why: Why = None, undo: Undo = False, output: Output = TEXT) -> None:
    """Exclude a run from every later calibration, or undo that; its data stay."""
    from zebro_lab.runs.exclusion import exclude_run, take_in_again
    from zebro_lab.runs.folder import require_ended

    require_ended(run)
    if undo:
        manifest = take_in_again(run, why=why)
        output.say(f"{run.name} is no longer excluded from calibrations")
        _print_excluded(run, manifest, output)
        return
    if why is None:
        raise typer.BadParameter(
            "missing; state why the run is excluded, for run.json", param_hint="'--why'"
        )
    manifest = exclude_run(run, why=why)
    output.say(f"{run.name} is excluded from calibrations: {(manifest.excluded or {})['why']}")
    _print_excluded(run, manifest, output)


def _print_excluded(run: Path, manifest: "RunManifest", output: Output) -> None:
    simulated = "sim:" in manifest.source
    content = {"folder": run, "simulated": simulated, "excluded": manifest.excluded}
    output.document("exclude", content)
