# SPDX-License-Identifier: MIT
"""`zebro-lab rig suggest`: points of a plan that tell most of a target."""

import typer

from zebro_lab.files.source_names import is_simulated
from zebro_lab.suggest.request import EXPECTED, SuggestRequest
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab rig suggest plan.toml --calibration calibration --target slip_stiffness

zebro-lab rig suggest plan.toml --calibration calibration --target force@0.02,0.05,0.2 --time 300

zebro-lab rig suggest plan.toml --calibration calibration --target walk:data/RUN --target friction

zebro-lab rig plan plan-suggested/plan.toml

A short plan with slips over the whole range and both ends of the loads is a good first calibration.
The suggestion is as good as the law: a few slips over the whole range are always kept to check it.
"""


@request_command(first=("plan", "calibration", "target", "time", "alone"))
def suggest(request: SuggestRequest, output: Output = TEXT) -> None:
    """Suggest slips, loads and duration of further points that make targets less uncertain."""
    from zebro_lab.suggest import stage
    from zebro_lab.suggest.folder import points_of
    from zebro_lab.suggest.screen import lines, print_suggested

    if not request.target:
        raise typer.BadParameter(f"missing: name {EXPECTED}", param_hint="'--target'")
    with output.progress() as watcher:
        suggested = stage.suggest(request, watcher)
    print_suggested(output.console(), suggested, request.out)
    content = {
        "folder": request.out,
        "simulated": is_simulated(suggested.source),
        "notes": lines(suggested),
        **points_of(suggested),
    }
    output.document("rig suggest", content)
