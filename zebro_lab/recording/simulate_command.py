# SPDX-License-Identifier: MIT
"""`zebro-lab sim`: a simulated device at a port that any program can open."""

from collections.abc import Callable
from typing import Annotated

import typer

from rig.clock import SYSTEM_CLOCK, Clock
from zebro_lab.recording.request import ImuTwinRequest, RigTwinRequest, ZebroTwinRequest
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import Range, request_command

app = Application(
    no_args_is_help=True, help="Run a simulated device and print the port to connect to."
)

Duration = Annotated[
    float | None,
    typer.Option(metavar="SECONDS", help="Duration [s]; default: until Ctrl-C."),
    Range(least=0),
]


@app.command()
@request_command()
def zebro(request: ZebroTwinRequest, duration: Duration = None, output: Output = TEXT) -> None:
    """Simulate the robot's legs, which walk a tripod gait or the leg angles of --play."""
    _serve(request, "sim zebro", duration, output)


@app.command()
@request_command()
def imu(request: ImuTwinRequest, duration: Duration = None, output: Output = TEXT) -> None:
    """Simulate an inertial measurement unit on a robot that walks."""
    _serve(request, "sim imu", duration, output)


@app.command()
@request_command()
def rig(request: RigTwinRequest, duration: Duration = None, output: Output = TEXT) -> None:
    """Simulate the slip rig, which repeats a slip sweep until a program commands its discs."""
    _serve(request, "sim rig", duration, output)


def _serve(
    request: ZebroTwinRequest | ImuTwinRequest | RigTwinRequest,
    command: str,
    duration: float | None,
    output: Output,
) -> None:
    """Serve a simulated device and print its ports, until a stop or the duration ends it."""
    from zebro_lab.recording.simulate_stage import serve

    profile = request.profile
    with output.progress() as watcher, serve(request) as served:
        for what, place in served.places.items():
            output.say(f"SIMULATED {what} ({served.source}), profile {profile}: {place}")
        output.say(f"to record the simulated device, use the address {served.address}")
        content = {"simulated": True, "source": served.source, "profile": profile}
        output.document(command, {**content, "ports": served.places, "address": served.address})
        wait_until(watcher.stop_requested, duration=duration)


def wait_until(
    stop_requested: Callable[[], bool], *, duration: float | None, clock: Clock = SYSTEM_CLOCK
) -> None:
    """Wait until a stop is requested or a duration has passed, polling every 50 ms.

    Args:
        stop_requested: Returns whether a stop is requested.
        duration: Longest wait [s]; None for no limit.
        clock: Clock of host time, which also sleeps.
    """
    end = clock.now() + (float("inf") if duration is None else duration)
    while not stop_requested() and clock.now() < end:
        clock.sleep(0.05)
