# SPDX-License-Identifier: MIT
"""`zebro-lab record`: devices into a run folder."""

import json
from typing import TYPE_CHECKING

import typer

from zebro_lab.files.source_names import is_simulated
from zebro_lab.recording.request import RecordRequest
from zebro_lab.runs.manifest import manifest_text
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.terminal.stopping import STOPPED
from zebro_lab.terminal.timely_output import leave_at_once

if TYPE_CHECKING:
    from zebro_lab.recording.stage import Recorded

EPILOG = """
Examples:

zebro-lab record --zebro sim --duration 10 --label first --data data

zebro-lab record --zebro zebro-100-serial@/dev/ttyUSB0 --play walk/path.csv --label circle
--data data

zebro-lab record --rig rig-odrive-netft@socketcan:can0 --label "POM on steel" --material
"POM on steel" --data data
"""


@request_command()
def record(request: RecordRequest, output: Output = TEXT) -> None:
    """Record a robot, IMUs or the slip rig into a new run folder in DIR: run.json, log.mcap."""
    from rich.console import Console

    from zebro_lab.recording import stage
    from zebro_lab.recording.screen import record_screen

    with record_screen(Console(stderr=True, quiet=output.quiet)) as screen:
        recorded = stage.record(request, screen)
        code = STOPPED if screen.signalled else 0
        told = screen.close() and output.say_in_time(_report(recorded))
    _print_document(recorded, output, code)
    if not told:
        leave_at_once(code)
    raise typer.Exit(code)


def _print_document(recorded: "Recorded", output: Output, code: int) -> None:
    """Print the contents of the run's `run.json` for `--json`; else nothing.

    A slow reader of the output may block this: the run has ended by then.
    """
    if output.as_json:
        run = json.loads(manifest_text(recorded.manifest))
        simulated = is_simulated(recorded.manifest.source)
        content = {"folder": recorded.folder, "simulated": simulated, "run": run}
        output.document("record", content, exit_code=code)


def _report(recorded: "Recorded") -> str:
    """Format the samples received, lost, rejected and dropped of each device, clocks and seed."""
    from zebro_lab.recording.drawing import clock_in_words

    manifest = recorded.manifest
    lines = []
    for name, counters in manifest.counters.items():
        rejected = sum(counters[key] for key in ("damaged", "repeated", "refused"))
        simulated = "SIMULATED " if is_simulated(manifest.sources[name]) else ""
        lines.append(
            f"{simulated}{name}: {counters['received']} samples received, {counters['lost']} lost "
            f"on the way, {rejected} rejected as damaged, repeated, impossible or for another "
            f"device, {counters['dropped']} dropped by a slow disk"
        )
    lines += [clock_in_words(name, clock) for name, clock in manifest.clocks.items()]
    if manifest.seed is not None:
        lines.append(f"simulated devices drew the random numbers of --seed {manifest.seed}")
    return "\n".join([*lines, f"recording {manifest.exit_status}; run folder {recorded.folder}"])
