# SPDX-License-Identifier: MIT
"""`zebro-lab record`: devices into a run folder."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

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
_ADDRESS = "PROFILE@PORT|sim|replay:RUN"
STOPPED = 130

Zebro = Annotated[str | None, typer.Option(metavar=_ADDRESS, help="Robot whose legs to record.")]
Imu = Annotated[
    list[str] | None,
    typer.Option(metavar=_ADDRESS, help="Inertial measurement unit beside it; repeat for two."),
]
Rig = Annotated[str | None, typer.Option(metavar=_ADDRESS, help="Slip rig to record.")]
Play = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Leg angles to send to the robot: path.csv or a leg log."),
]
Duration = Annotated[
    float | None,
    typer.Option(
        help="How long, from the first samples; without it until q, Ctrl-C or the end of the "
        "played gait or replayed run [s]."
    ),
]
Label = Annotated[str, typer.Option(help="Name of the run.")]
Data = Annotated[Path, typer.Option(metavar="DIR", help="Folder of run folders.")]
Material = Annotated[str, typer.Option(help="Leg and ground material.")]
Operator = Annotated[str, typer.Option(help="Who records.")]
Robot = Annotated[str | None, typer.Option(help="Name of the robot, for the record.")]
Seed = Annotated[int, typer.Option(min=0, help="Of the randomness of simulated devices.")]


def record(
    label: Label,
    data: Data,
    zebro: Zebro = None,
    play: Play = None,
    imu: Imu = None,
    rig: Rig = None,
    duration: Duration = None,
    material: Material = "unknown",
    operator: Operator = "unknown",
    robot: Robot = None,
    seed: Seed = 0,
) -> None:
    """Record a robot, an IMU or the slip rig: DIR/RUN/{run.json, log.mcap}."""
    from rich.console import Console

    from zebro_lab.recording.screen import record_screen
    from zebro_lab.recording.stage import RecordRequest
    from zebro_lab.recording.stage import record as run
    from zebro_lab.terminal.last_words import leave_at_once, say_in_time

    request = RecordRequest(
        data=data,
        label=label,
        zebro=zebro,
        imus=tuple(imu or ()),
        rig=rig,
        play=play,
        duration=duration,
        material=material,
        operator=operator,
        robot=robot,
        seed=seed,
    )
    with record_screen(Console(stderr=True)) as screen:
        recorded = run(request, screen)
        code = STOPPED if screen.signalled else 0
        if not (screen.close() and say_in_time(_report(recorded))):
            leave_at_once(code)
    raise typer.Exit(code)


def _report(recorded: "Recorded") -> str:
    manifest = recorded.manifest
    lines = []
    for name, counters in manifest.counters.items():
        rejected = sum(counters[key] for key in ("damaged", "repeated", "refused"))
        simulated = "SIMULATED " if manifest.sources[name].startswith("sim:") else ""
        lines.append(
            f"{simulated}{name}: {counters['received']} samples, {counters['lost']} lost, "
            f"{rejected} rejected, {counters['dropped']} dropped"
        )
    for name, clock in manifest.clocks.items():
        pace = "slow" if clock["drift"] > 0 else "fast"
        lines.append(
            f"clock of {name}: offset {clock['offset']:.6f} s, {1e6 * abs(clock['drift']):.1f} ppm "
            f"{pace}; half of the samples arrive more than {1e3 * clock['delay']:.2f} ms after the "
            "fastest"
        )
    return "\n".join([*lines, f"{manifest.exit_status}: {recorded.folder}"])
