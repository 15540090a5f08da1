# SPDX-License-Identifier: MIT
"""`zebro-lab plot RUN`: plot all raw streams of a run in one picture."""

from pathlib import Path
from typing import Annotated

import typer

from model.counted import counted
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.picture_options import Instants, Window, parse_instants, parse_window
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab plot data/20260304T050607Z_walk_circle

zebro-lab plot data/20260304T050607Z_walk_circle --out circle.png

zebro-lab plot data/20260304T050607Z_walk_circle --format pdf --window 20:24 --at 21.5,22
"""

Run = Annotated[Path, typer.Argument(metavar="RUN", help="Run folder.")]
Out = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Picture to write; default: RUN.png beside RUN.")
]
Form = Annotated[
    PictureFormat | None,
    typer.Option("--format", help="Format of the picture; default: as --out ends, else png."),
]
Shown = Annotated[
    Window | None,
    typer.Option(
        parser=parse_window, metavar="BEGIN:END",
        help="Time of the run that is drawn [s]; default: all.",
    ),
]  # fmt: skip


Marked = Annotated[
    Instants | None,
    typer.Option(
        parser=parse_instants, metavar="T1,T2,…",
        help="Times of the run to mark with a line in every panel [s].",
    ),
]  # fmt: skip


@request_command()
def plot(
    run: Run,
    out: Out = None,
    form: Form = None,
    at: Marked = None,
    window: Shown = None,
    output: Output = TEXT,
) -> None:
    """Plot all recorded streams of a run over time in one picture; mark gaps and events."""
    from zebro_lab.runs.plot_stage import plot_run

    with output.progress() as watcher:
        watcher.step("drawing", None)
        marked = () if at is None else at.t
        drawn = plot_run(run, out=out, form=form, at=marked, window=window)
    output.say(*drawn.signals.notes)
    for panel in drawn.signals.panels:
        simulated = "SIMULATED " if panel.simulated else ""
        gaps = f", {counted(len(panel.gaps), 'gap')}" if len(panel.gaps) else ""
        output.say(f"{simulated}{panel.title}: {counted(len(panel.t), 'sample')}{gaps}")
    output.say(f"wrote {drawn.file}")
    samples = {panel.title: len(panel.t) for panel in drawn.signals.panels}
    simulated = any(panel.simulated for panel in drawn.signals.panels)
    content = {"simulated": simulated, "samples": samples, "notes": list(drawn.signals.notes)}
    output.document("plot", {**content, "written": [drawn.file]})
