# SPDX-License-Identifier: MIT
"""`zebro-lab record`: devices into a run folder."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.recording.request import RecordRequest
from zebro_lab.terminal.request_command import request_command

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
STOPPED = 130


@request_command()
def record(request: RecordRequest) -> None:
    """Record a robot, IMUs or the slip rig into a new run folder in DIR: run.json, log.mcap."""
    from rich.console import Console

    from zebro_lab.recording import stage
    from zebro_lab.recording.screen import record_screen
    from zebro_lab.terminal.compiling import announcing_compilation
    from zebro_lab.terminal.last_words import leave_at_once, say_in_time

    with record_screen(Console(stderr=True)) as screen, announcing_compilation():
        recorded = stage.record(request, screen)
        code = STOPPED if screen.signalled else 0
        if not (screen.close() and say_in_time(_report(recorded))):
            leave_at_once(code)
    raise typer.Exit(code)


def _report(recorded: "Recorded") -> str:
    from zebro_lab.recording.clock_text import clock_in_words

    manifest = recorded.manifest
    lines = []
    for name, counters in manifest.counters.items():
        rejected = sum(counters[key] for key in ("damaged", "repeated", "refused"))
        simulated = "SIMULATED " if manifest.sources[name].startswith("sim:") else ""
        lines.append(
            f"{simulated}{name}: {counters['received']} samples received, {counters['lost']} lost "
            f"on the way, {rejected} rejected as damaged, repeated, impossible or for another "
            f"device, {counters['dropped']} dropped by a slow disk"
        )
    lines += [clock_in_words(name, clock) for name, clock in manifest.clocks.items()]
    return "\n".join([*lines, f"recording {manifest.exit_status}; run folder {recorded.folder}"])
