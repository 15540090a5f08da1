# SPDX-License-Identifier: MIT
"""`zebro-lab runs` and `exclude`: list runs, and leave runs out of calibrations."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from model.counted import counted
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from zebro_lab.runs.manifest import RunManifest
    from zebro_lab.runs.stage import ListedRun

DataDir = Annotated[Path, typer.Argument(metavar="DATA", help="Folder to search for run folders.")]
RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
Why = Annotated[str | None, typer.Option(help="Reason, kept in run.json; required without --undo.")]
Undo = Annotated[bool, typer.Option("--undo", help="Undo the exclusion of the run.")]


@request_command()
def runs(data: DataDir, output: Output = TEXT) -> None:
    """List recorded runs with their state, duration, samples and source."""
    from zebro_lab.runs.stage import list_runs

    listed = list_runs(data)
    output.say(*map(_in_words, listed), f"{counted(len(listed), 'run')} in {data}")
    simulated = any(is_simulated(run.source or "") for run in listed)
    output.document("runs", {"simulated": simulated, "runs": [_in_numbers(run) for run in listed]})


def _in_words(run: "ListedRun") -> str:
    """Format a run as one line: name, state, duration, samples and source."""
    lasted = "-" if run.duration is None else f"{run.duration:.1f} s"
    samples = ", ".join(f"{count} {topic}" for topic, count in run.samples.items()) or "-"
    source = run.source or "-"
    simulated = "SIMULATED " if is_simulated(source) else ""
    return f"{run.name}  {run.state}  {lasted}  {samples}  {simulated}{source}"


def _in_numbers(run: "ListedRun") -> dict[str, object]:
    """Return a run as an entry of the JSON document."""
    return {
        "name": run.name,
        "state": run.state,
        "duration_s": run.duration,
        "samples": dict(run.samples),
        "source": run.source,
    }


@request_command()
def exclude(run: RunFolder, why: Why = None, undo: Undo = False, output: Output = TEXT) -> None:
    """Exclude a run from every later calibration, or undo that; its data stay."""
    from zebro_lab.runs.exclusion import exclude_run, take_in_again

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
    """Print the exclusion of a run as a JSON document, where that is asked for."""
    simulated = is_simulated(manifest.source)
    content = {"folder": run, "simulated": simulated, "excluded": manifest.excluded}
    output.document("exclude", content)
