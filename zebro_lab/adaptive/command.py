# SPDX-License-Identifier: MIT
"""`zebro-lab rig run`: run a plan once, or with --adaptive in rounds that are fitted in between."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.adaptive.request import AdaptiveRequest
from zebro_lab.experiment.command import REFUSED, STOPS, carry_out, end
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.terminal.stopping import StoppedBySignal

if TYPE_CHECKING:
    from rig.experiment.run import Outcome
    from zebro_lab.adaptive.stage import Adapted
    from zebro_lab.experiment.request import RigRunRequest

EPILOG = f"""
Examples:

zebro-lab rig run plan.toml --rig sim --fast

zebro-lab rig run plan.toml --rig sim --fast --adaptive slip_stiffness=0.5 --budget 600

zebro-lab rig run plan.toml --rig sim --fast --adaptive force@0.02,0.2=0.03

With --adaptive PLAN is the first round. All rounds are fitted by the first answer of calibrate-slip
while the rig stands de-energised, and the next is planned as by rig suggest. DIR gets a folder
for each round, and calibration; calibrate-slip DIR fits all rounds.
{STOPS}"""


@request_command(first=("plan", "rig", "data", "resume", "adaptive", "budget"))
def run(request: AdaptiveRequest, output: Output = TEXT) -> None:
    """Run a plan; record each point to a run folder, as calibrate-slip reads them."""
    if request.adaptive:
        _adapt(request, output)
        return
    outcome, latched = carry_out(request, output)
    end(outcome, request.data, output, latched=latched)


def _adapt(request: AdaptiveRequest, output: Output) -> None:
    """Run an adaptive experiment and exit: 0 reached or nothing to reach, `REFUSED` if not."""
    from zebro_lab.adaptive.rounds import ROUNDS_FILE
    from zebro_lab.adaptive.screen import in_numbers, rounds_table, told
    from zebro_lab.adaptive.stage import adapt
    from zebro_lab.calibration.stage import Stopped
    from zebro_lab.files.source_names import is_simulated

    latched = False

    def measure(round_: "RigRunRequest") -> "Outcome":
        nonlocal latched
        outcome, latched = carry_out(round_, output)
        return outcome

    try:
        found = adapt(
            request, measure=measure, working=output.progress,
            tell=lambda each: output.say(told(each, request.wanted)),
        )  # fmt: skip
    except (Stopped, StoppedBySignal):
        if (request.data / ROUNDS_FILE).exists():
            output.say(f"what was measured is kept in {request.data}; the same command with "
                       "--resume goes on")  # fmt: skip
        raise
    if found.stopped is not None and found.outcome is not None:
        end(found.outcome, found.stopped, output, latched=latched)
    output.console().print(rounds_table(found.rounds, request.wanted))
    output.say(f"{_ending(found)}: {found.reason}")
    output.say(f"results in {request.data}; next: calibrate-slip {request.data}")
    code = 0 if found.reached and not found.rounds[-1].refused else REFUSED
    source = None if found.outcome is None else found.outcome.source
    content = {
        "folder": request.data,
        "simulated": None if source is None else is_simulated(source),
        "source": source,
        "reason": found.reason,
        "reached": found.reached,
        "rounds": in_numbers(found.rounds),
    }
    output.document("rig run", content, exit_code=code)
    raise typer.Exit(code)


def _ending(found: "Adapted") -> str:
    return "finished" if found.reached else "finished, and an interval is wider than asked"
