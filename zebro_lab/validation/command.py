# SPDX-License-Identifier: MIT
"""`zebro-lab validate`: errors of predicted paths against tracked ones."""

import typer

from zebro_lab.terminal.messages import wide_console
from zebro_lab.terminal.request_command import request_command
from zebro_lab.validation.request import ValidateRequest

EPILOG = """
Examples:

zebro-lab validate data/20260101T120000Z_walk_tiles

zebro-lab validate --predicted prediction --track track/track.csv --out validation

zebro-lab validate --predicted a/prediction --track a/track --predicted b/prediction --track b/track

zebro-lab validate data/RUN --estimate-offset

Unaligned errors come first: alignment hides a wrong start and a wrong heading. Every path starts
from the first tracked pose, which is not scored.
"""


@request_command()
def validate(request: ValidateRequest) -> None:
    """Compute the errors of predicted paths against tracked ones, with baselines."""
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.validation import stage
    from zebro_lab.validation.screen import print_validated

    n_predicted, n_tracks = len(request.predicted), len(request.track)
    if n_predicted != n_tracks or not (request.runs or n_predicted):
        raise typer.BadParameter(
            f"{n_predicted} --predicted and {n_tracks} --track; give the same number of both, one "
            "or more, or run folders"
        )
    if request.estimate_offset and request.time_offset:
        raise typer.BadParameter("give --time-offset, or let --estimate-offset find it; not both")
    with progress_bar() as watcher:
        validated = stage.validate(request, watcher)
    print_validated(wide_console(), validated, request.folder)
