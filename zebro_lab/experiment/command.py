# SPDX-License-Identifier: MIT
"""`zebro-lab rig plan|run|say|weigh|check`: experiments of the slip rig."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from zebro_lab.experiment.request import Data, RigRunRequest, WeighRequest
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.terminal.stopping import STOPPED

if TYPE_CHECKING:
    from rig.experiment.control import Control
    from rig.experiment.run import Outcome
    from rig.experiment.weigh import GainCheck, Weighing
    from zebro_lab.experiment.plan_stage import Foreseen

REFUSED = 3

app = Application(
    help="Run experiments on the slip rig. Not a safety device: keep an emergency stop at hand.",
    no_args_is_help=True,
)

RUN_EPILOG = """
Examples:

zebro-lab rig run plan.toml --rig sim --fast

zebro-lab rig run plan.toml --rig rig-odrive-netft@socketcan:can0 --data data --resume

Ctrl-C once: soft stop (ramp to standstill, stay energised; r and Enter resume). Twice: safe stop
(ramp to standstill, de-energise, end). Three times: emergency stop (de-energise at once, latched).
SIGTERM, Ctrl-\\, Ctrl-Z and a lost connection or closed terminal (SIGHUP, unless started with
nohup): safe stop.

Exit codes: 0 completed, 1 error, 2 usage, 3 completed but points were refused, 130 stopped.
"""


@app.command()
@request_command()
def plan(
    file: Annotated[Path, typer.Argument(metavar="PLAN", help="Plan file (TOML).")],
    rig: Annotated[
        str, typer.Option(metavar="PROFILE", help="Profile of the rig; sim: rig-board-serial.")
    ] = "sim",
    steps: Annotated[bool, typer.Option("--steps", help="List every step of the plan.")] = False,
    output: Output = TEXT,
) -> None:
    """Check a plan by its own limits and the rig's; print duration and number of points."""
    from zebro_lab.experiment.plan_stage import foresee

    foreseen = foresee(file, rig)
    _print_plan(foreseen, output, steps=steps)
    plan, estimate = foreseen.plan, foreseen.estimate
    content = {"plan": plan.name, "material": plan.material, "profile": foreseen.profile.name}
    numbers = {"points": estimate.points, "loads": estimate.loads, "duration_s": estimate.seconds}
    output.document("rig plan", {**content, **numbers})


@app.command(epilog=RUN_EPILOG)
@request_command(first=("plan", "rig", "data", "resume"))
def run(request: RigRunRequest, output: Output = TEXT) -> None:
    """Run a plan; record each point to a run folder, as calibrate-slip reads them."""
    from rich.console import Console

    from rig.experiment.control import Control
    from zebro_lab.experiment.screen import experiment_screen
    from zebro_lab.experiment.stage import run_experiment

    control = Control()
    try:
        beside = output.as_json or output.quiet
        console = Console(stderr=beside, highlight=False, soft_wrap=True)
        with experiment_screen(console, control, quiet=output.quiet) as screen:
            outcome = run_experiment(request, screen, control)
    finally:
        if control.stop.latched:
            _say_latched(request.data)
    _end(outcome, request.data, output, latched=control.stop.latched)


def _say_latched(data: Path) -> None:
    from zebro_lab.terminal.timely_output import say_in_time

    say_in_time(
        f"an emergency stop is latched in {data}; inspect the rig, then repeat the command with "
        "--resume --reset-emergency",
        err=True,
    )


def _end(outcome: "Outcome", data: Path, output: Output, *, latched: bool) -> NoReturn:
    """Print how an experiment ended, and exit with 0, `REFUSED` or `STOPPED`."""
    from model.counted import counted
    from zebro_lab.experiment.documents import experiment_in_numbers
    from zebro_lab.experiment.journal import read_journal
    from zebro_lab.terminal.timely_output import leave_at_once

    words = (
        f"{outcome.reason}: {counted(outcome.finished, 'point')} finished, "
        f"{counted(len(outcome.refused), 'point')} failed all attempts, "
        f"{counted(outcome.attempts, 'attempt')} in this run; results in {data}"
    )
    if not outcome.completed and not latched:
        words += "\nto continue, repeat the command with --resume"
    refused = REFUSED if outcome.refused else 0
    code = refused if outcome.completed else STOPPED
    told = output.say_in_time(words)
    if output.as_json:  # who reads it is waited for: the rig is at rest by now
        content = experiment_in_numbers(outcome, read_journal(data), data)
        output.document("rig run", {**content, "latched": latched}, exit_code=code)
    if not told:
        leave_at_once(code)
    raise typer.Exit(code)


@app.command("say")
@request_command()
def command(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="WORDS",
            help="pause, resume, confirm, note TEXT, status, or a stop: soft, safe or emergency.",
        ),
    ],
    data: Data = Path("experiment"),
    output: Output = TEXT,
) -> None:
    """Send a command to the running experiment that records to DIR."""
    from zebro_lab.experiment.stage import command_run

    reply = command_run(data, " ".join(words))
    output.say(reply)
    output.document("rig say", {"reply": reply})


@app.command()
@request_command()
def weigh(request: WeighRequest, output: Output = TEXT) -> None:
    """Check the load cell with known weights; the result is the gain's prior in a calibration."""
    from rig.experiment.control import Control
    from zebro_lab.experiment.documents import weighing_in_numbers
    from zebro_lab.experiment.weigh_stage import weigh_masses

    control = Control()
    weighing, check, written = weigh_masses(request, _Asker(control, output), control)
    _print_weighing(weighing, check, written, output)
    output.document("rig weigh", weighing_in_numbers(weighing, check, written))


def _print_weighing(
    weighing: "Weighing", check: "GainCheck", written: Path | None, output: Output
) -> None:
    from zebro_lab.experiment.weigh_stage import render_load_cell

    for force, reading, error in zip(
        weighing.forces, weighing.readings, weighing.errors, strict=True
    ):
        output.say(
            f"weight of {force:8.3f} N: the load cell reads {reading:8.4f} +/- {error:.4f} N"
        )
    output.say(
        f"reading per force {check.slope:.5f} +/- {check.slope_sd:.5f} (expected 1), unloaded "
        f"{check.zero:.4f} +/- {check.zero_sd:.4f} N, largest residual {check.misfit:.4f} N"
    )
    if abs(check.slope - 1) > 2 * check.slope_sd:
        output.say(
            "the gain is wrong: in the rig's profile (a copy, if it is a shipped one) multiply "
            f"counts_per_force by {abs(check.slope):.5f}"
            f"{', reverse the sign of the normal force' if check.slope < 0 else ''}, then run "
            "`zebro-lab rig weigh` again with it"
        )
    lines = render_load_cell(check).splitlines() if written is None else [f"wrote {written}"]
    for line in lines:
        output.say(line)


@app.command()
@request_command()
def check(
    data: Annotated[
        list[Path], typer.Argument(metavar="DATA", help="New runs or tables, or folders of them.")
    ],
    slip: Annotated[Path, typer.Option(help="The calibration: slip.toml or its folder.")] = Path(
        "calibration"
    ),
    output: Output = TEXT,
) -> None:
    """Compare the traction of new runs with a calibration to detect drift of the rig."""
    from zebro_lab.experiment.check_stage import SUSPICIOUS, check_runs
    from zebro_lab.experiment.documents import checked_in_numbers

    done = check_runs(data, slip)
    runs = done.runs
    for found in runs:
        output.say(
            f"{found.name}: mean slip {found.slip:.4f}, normal force {found.load:.2f} N, traction "
            f"{found.traction:.3f} N, expected {found.expected:.3f} +/- {found.sd:.3f} N, off by "
            f"{found.deviation:+.1f} sd {found.verdict}".rstrip()
        )
    drifted = sum(found.verdict == "DRIFTED" for found in runs)
    output.say(
        f"{drifted} of {len(runs)} runs deviate from the calibration by over {SUSPICIOUS:g} sd"
    )
    code = REFUSED if any(found.verdict for found in runs) else 0
    simulated = any(is_simulated(source) for source in done.sources)
    content = {"simulated": simulated, "runs": [checked_in_numbers(run) for run in runs]}
    output.document("rig check", content, exit_code=code)
    if code:
        raise typer.Exit(REFUSED)


class _Asker:
    """Prompter of the operator: shows each new instruction once and confirms on Enter."""

    def __init__(self, control: "Control", output: Output) -> None:
        self._control = control
        self._output = output
        self._asked = ""

    def __call__(self, text: str, normal: float) -> None:
        if text and text != self._asked:
            self._asked = text
            question = f"{text} with Enter (now {normal:.3f} N)"
            with self._output.asking():
                typer.prompt(question, default="", show_default=False)
            self._control.confirm()


def _print_plan(foreseen: "Foreseen", output: Output, *, steps: bool) -> None:
    from model.counted import counted
    from rig.experiment.plan import LIMIT_UNITS
    from rig.experiment.steps import Point

    plan, points = foreseen.plan, foreseen.plan.points
    minutes, seconds = divmod(round(foreseen.estimate.seconds), 60)
    output.say(f"plan '{plan.name}', material {plan.material}, rig profile {foreseen.profile.name}")
    output.say(
        f"{counted(foreseen.estimate.points, 'point')} in all, check points included: "
        f"{counted(len(points.loads), 'load')} x {counted(len(points.slips), 'slip ratio')}, "
        f"gone through {counted(points.repeats, 'time')}, "
        f"order {points.order}{', slip ratios as one sweep' if points.sweep else ''}"
    )
    output.say(
        f"the load is set {counted(foreseen.estimate.loads, 'time')}, 0 N included, by "
        f"{plan.load.set_by}"
    )
    output.say(f"the plan takes about {minutes} min {seconds} s if every point is good at once")
    output.say("limits of the plan, which all set-points keep, as those of the profile:")
    for name, unit in LIMIT_UNITS.items():
        value = getattr(plan.limits, name)
        limit = "the profile's, if any" if value is None else f"{value:g} {unit}"
        output.say(f"  {name:<20}{limit:>24}")
    if plan.limits.guards_off:
        output.say(f"guards switched off by the plan: {plan.limits.guards_off_text}")
    if steps:
        for step in foreseen.steps:
            output.say(step.label if isinstance(step, Point) else f"zero-{step.number:04d}")
