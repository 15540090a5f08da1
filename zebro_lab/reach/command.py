# SPDX-License-Identifier: MIT
"""`zebro-lab reach`: compare stop-turn-walk with a curve for goals."""

import typer

from zebro_lab.reach.request import ReachRequest
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab reach --goal 1,0.5 --slip thesis

zebro-lab reach --goal 1,0.5,90 --slip calibration --gait tetrapod --cycle 3

zebro-lab reach --goal 1,0 --goal 0,0.8 --goal -1,0 --goal 0.1,0.05 --goal 3,1.5 --slip thesis
--out five

zebro-lab walk reach/curve.toml --slip thesis --figures

Parts of a manoeuvre are whole strides, whose stances are as long as to end at the goal.
"""


@request_command(first=("goal", "slip", "out"))
def reach(request: ReachRequest, output: Output = TEXT) -> None:
    """Plan and walk two ways to a place: stop, turn, walk, and a curve; compare time and work."""
    from zebro_lab.reach import screen, stage
    from zebro_lab.walk.output import WalkStopped

    if not request.goal:
        raise typer.BadParameter(
            "missing: name a place, such as 1,0.5 for 1 m ahead and 0.5 m to the left",
            param_hint="'--goal'",
        )
    request.model.require_slip()
    with output.progress(WalkStopped) as watcher:
        reached = stage.reach(request, watcher)
    screen.print_reached(output.console(), reached, request.out)
    output.document("reach", {**screen.reach_document(reached), "folder": request.out})
