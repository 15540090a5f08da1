# SPDX-License-Identifier: MIT
"""`zebro-lab track`: the path of a robot from photographs."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.track.request import TrackRequest

if TYPE_CHECKING:
    from zebro_lab.track.stage import TrackResult

EPILOG = """
Examples:

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --out track
--preview preview.png

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --run DATA/RUN
--clock clock.jpg

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --interval 2
--without-marker --annotations annotations.toml --out track

zebro-lab track composite.jpg --camera camera.toml --floor floor.toml --robot robot.toml
--interval 4 --out track
"""


PreviewPng = Annotated[
    Path | None,
    typer.Option(
        metavar="PNG", help="Analyse only the first photograph, and draw what is found in it."
    ),
]


@request_command()
def track(request: TrackRequest, preview: PreviewPng = None, output: Output = TEXT) -> None:
    """Track the robot in photographs; write track.csv with covariance, track.tum, pictures."""
    from tracking.errors import TrackStopped
    from zebro_lab.track import screen, stage

    if preview is not None:
        seen = stage.preview(request, preview)
        for line in (*screen.preview_lines(seen), f"wrote {preview}"):
            output.say(line)
        output.document("track", {"written": [preview]})
        if any(check.is_off for check in seen.tape):
            sys.stderr.write("distances marked off differ by over 4 mm; measure the floor again\n")
        return
    if request.out is None and request.run is None:
        raise typer.BadParameter("missing: give --run RUN or --out FOLDER", param_hint="'--run'")
    with output.progress(TrackStopped) as watcher:
        result = stage.track(request, watcher)
    for line in screen.track_lines(result):
        output.say(line)
    _print_document(result, output)


def _print_document(result: "TrackResult", output: Output) -> None:
    """Print source, numbers and notes of a track as JSON, if that is asked for."""
    track = result.tracked.track
    content = {"folder": result.folder, "simulated": is_simulated(result.source)}
    numbers = {
        "source": result.source,
        "photographs": result.photos,
        "poses": len(track.t),
        "duration_s": track.t[-1] - track.t[0],
    }
    notes = {"left_out": dict(result.tracked.lost), "notes": list(result.tracked.notes)}
    output.document("track", {**content, **numbers, **notes})
