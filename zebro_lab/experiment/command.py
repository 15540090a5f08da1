# SPDX-License-Identifier: MIT
"""`zebro-lab rig plan|run|say|weigh|check`: experiments of the slip rig."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from model.counted import counted
from zebro_lab.experiment.journal import read_journal
from zebro_lab.experiment.request import Data, RigRunRequest, WeighRequest
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.terminal.stopping import STOPPED
from zebro_lab.terminal.timely_output import leave_at_once, say_in_time

if TYPE_CHECKING:
    from rig.experiment.control import Control
    from rig.experiment.run import RunOutcome
    from rig.experiment.weigh import GainCheck, Weighing
    from zebro_lab.experiment.check_stage import CheckedRun
    from zebro_lab.experiment.journal import Journal


def experiment_in_numbers(outcome: "RunOutcome", journal: "Journal", data: Path) -> dict[str, Any]:
    """Return how an experiment ended, and each run folder that was closed in it.

    Args:
        outcome: Outcome of the command's run.
        journal: Journal of the experiment, with the runs of earlier commands.
        data: Folder of the experiment.
    """
    return {
        "folder": data,
        "simulated": is_simulated(outcome.source),
        "source": outcome.source,
        "reason": outcome.reason,
        "finished": outcome.finished,
        "refused": outcome.refused,
        "attempts": outcome.attempts,
        "runs": [_run_in_numbers(entry) for entry in journal.points],
    }


def _run_in_numbers(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a journal's entry of a run; its numbers are None where the run was cut short."""
    accepted = entry.get("accepted") is True
    return {
        "name": entry.get("folder"),
        "point": entry.get("number"),
        "attempt": entry.get("attempt"),
        "accepted": accepted,
        "why": None if accepted else entry.get("text"),
        "slip_ratio": entry.get("slip"),
        "friction": entry.get("friction"),
        "normal_force_N": entry.get("normal"),
    }


def weighing_in_numbers(
    weighing: "Weighing", check: "GainCheck", written: Path | None
) -> dict[str, Any]:
    """Return the readings of a load cell under known weights, and the line through them."""
    columns = zip(weighing.forces, weighing.readings, weighing.errors, strict=True)
    return {
        "simulated": is_simulated(weighing.source),
        "written": [] if written is None else [written],
        "weights": [
            {"force_N": force, "reading_N": reading, "standard_error_N": error}
            for force, reading, error in columns
        ],
        "slope": check.slope,
        "slope_sd": check.slope_sd,
        "zero_N": check.zero,
        "zero_sd_N": check.zero_sd,
        "largest_residual_N": check.misfit,
        "gain_sd": check.gain_sd,
        "bias_sd_N": check.bias_sd,
    }


def checked_in_numbers(run: "CheckedRun") -> dict[str, Any]:
    """Return the comparison of one run with a calibration."""
    return {
        "name": run.name,
        "slip_ratio": run.slip,
        "normal_force_N": run.load,
        "traction_N": run.traction,
        "expected_N": run.expected,
        "sd_N": run.sd,
        "verdict": run.verdict or "ok",
    }


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
    from zebro_lab.experiment.plan_stage import foresee, in_words

    foreseen = foresee(file, rig)
    for line in in_words(foreseen, steps=steps):
        output.say(line)
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
    """Print on standard error that an emergency stop is latched, and how to go on."""
    say_in_time(
        f"an emergency stop is latched in {data}; inspect the rig, then repeat the command with "
        "--resume --reset-emergency",
        err=True,
    )


def _end(outcome: "RunOutcome", data: Path, output: Output, *, latched: bool) -> NoReturn:
    """Print how an experiment ended, and exit with 0, `REFUSED` or `STOPPED`."""
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


@app.command("say", context_settings={"ignore_unknown_options": True})
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
    from zebro_lab.experiment.say_stage import command_run, is_emergency

    unknown = next((word for word in words if word.startswith("--")), None)
    if unknown is not None and not is_emergency(words[0]):  # a stop takes any text
        raise typer.BadParameter(f"there is no option {unknown}")
    reply = command_run(data, " ".join(words))
    output.say(reply)
    output.document("rig say", {"reply": reply})


@app.command()
@request_command()
def weigh(request: WeighRequest, output: Output = TEXT) -> None:
    """Check the load cell with known weights; the result is the gain's prior in a calibration."""
    from rig.experiment.control import Control
    from zebro_lab.experiment.weigh_stage import in_words, weigh_masses

    control = Control()
    weighing, check, written = weigh_masses(request, _Asker(control, output), control)
    for line in in_words(weighing, check, written):
        output.say(line)
    output.document("rig weigh", weighing_in_numbers(weighing, check, written))


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
    from zebro_lab.experiment.check_stage import check_runs

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
        f"{drifted} of {len(runs)} runs deviate from the calibration by over {runs[0].limit:.1f} sd"
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
        """Show a new instruction with the present normal force [N], and wait for Enter."""
        if text and text != self._asked:
            self._asked = text
            question = f"{text} with Enter (now {normal:.3f} N)"
            with self._output.asking():
                typer.prompt(question, default="", show_default=False)
            self._control.confirm()
