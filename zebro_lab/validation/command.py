# SPDX-License-Identifier: MIT
"""`zebro-lab validate`: errors of predicted paths against tracked ones."""

from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:

zebro-lab validate data/20260101T120000Z_walk_tiles

zebro-lab validate --predicted prediction --track track/track.csv --out validation

zebro-lab validate --predicted a/prediction --track a/track --predicted b/prediction --track b/track

zebro-lab validate data/RUN --estimate-offset

Unaligned errors come first: alignment hides a wrong start and a wrong heading. Every path starts
from the first tracked pose, which is not scored.
"""


def validate(
    runs: Annotated[
        list[Path] | None, typer.Argument(help="Run folders with prediction/ and track/.")
    ] = None,
    predicted: Annotated[
        list[Path] | None,
        typer.Option(help="Walk folder of predict, or a table with t, x, y, yaw; repeatable."),
    ] = None,
    track: Annotated[
        list[Path] | None, typer.Option(help="track.csv, or its folder; one a --predicted.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Validation folder; RUN/validation of one run, else validation."),
    ] = None,
    anchor: Annotated[
        bool,
        typer.Option(
            "--anchor/--no-anchor",
            help="Start from the first tracked pose; or take paths where they are.",
        ),
    ] = True,
    time_offset: Annotated[
        float, typer.Option(help="Added to the track's times: its clock is so far behind [s].")
    ] = 0.0,
    estimate_offset: Annotated[
        bool,
        typer.Option(
            "--estimate-offset",
            help="Find in the motion how far the track's clock is behind: starts, stops and turns "
            "tell it, an even walk does not.",
        ),
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1,
) -> None:
    """Compute the errors of predicted paths against tracked ones, with baselines."""
    from rich.console import Console

    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.terminal.tables import wide_console
    from zebro_lab.validation.predicted_walks import pairs_of_run
    from zebro_lab.validation.screen import print_validated
    from zebro_lab.validation.stage import ValidateRequest
    from zebro_lab.validation.stage import validate as run

    runs, predicted, track = runs or [], predicted or [], track or []
    if len(predicted) != len(track) or not (runs or predicted):
        raise typer.BadParameter(
            f"{len(predicted)} --predicted and {len(track)} --track; name as many of both, or "
            "run folders"
        )
    if estimate_offset and time_offset:
        raise typer.BadParameter("give --time-offset, or let --estimate-offset find it; not both")
    pairs = [pairs_of_run(each) for each in runs] + list(zip(predicted, track, strict=True))
    if out is None:
        out = runs[0] / "validation" if len(runs) == 1 and not predicted else Path("validation")
    with progress_bar(Console(stderr=True)) as watcher:
        offset = None if estimate_offset else time_offset
        validated = run(ValidateRequest(tuple(pairs), out, anchor, offset, seed), watcher)
    print_validated(wide_console(), validated, out)
