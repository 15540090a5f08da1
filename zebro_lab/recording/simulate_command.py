# SPDX-License-Identifier: MIT
"""`zebro-lab sim`: a simulated device at a port that any program can open."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.terminal.messages import say

if TYPE_CHECKING:
    from zebro_lab.recording.simulate_stage import Served, TwinRequest

app = typer.Typer(
    no_args_is_help=True, help="Run a simulated device and print the port to connect to."
)

Play = Annotated[Path | None, typer.Option(metavar="FILE", help="Leg angles to walk: path.csv.")]
Can = Annotated[
    str | None,
    typer.Option(
        "--can",
        metavar="INTERFACE:CHANNEL",
        help="Bus for devices on CAN; without it an adapter at a port that speaks SLCAN.",
    ),
]
AsSocket = Annotated[
    bool, typer.Option("--socket", help="Listen on socket:// in place of a pseudo-terminal.")
]
Flip = Annotated[float, typer.Option(min=0.0, max=1.0, help="Probability that a bit flips.")]
Drop = Annotated[float, typer.Option(min=0.0, max=1.0, help="Probability that a frame is lost.")]
Garbage = Annotated[
    float, typer.Option(min=0.0, max=1.0, help="Probability of garbage between frames.")
]
Jitter = Annotated[float, typer.Option(min=0.0, help="Spread of when a frame is taken [s].")]
Pause = Annotated[
    float, typer.Option(min=0.0, max=1.0, help="Probability of a pause before a flight.")
]
Seed = Annotated[int, typer.Option(min=0, help="Of the randomness.")]
Duration = Annotated[
    float | None, typer.Option(min=0.0, help="How long; without it until Ctrl-C [s].")
]


@app.command()
def zebro(
    profile: Annotated[str, typer.Argument()] = "zebro-100-serial",
    play: Play = None,
    can: Can = None,
    as_socket: AsSocket = False,
    flip: Flip = 0.0,
    drop: Drop = 0.0,
    garbage: Garbage = 0.0,
    jitter: Jitter = 0.0,
    pause: Pause = 0.0,
    seed: Seed = 0,
    duration: Duration = None,
) -> None:
    """Simulate the robot's leg stream; it walks a tripod, or what --play says."""
    from rig.links.faults import Faults
    from rig.zebro.simulated_legs import RobotImperfections
    from zebro_lab.recording.simulate_stage import TwinRequest, serve_zebro

    request = TwinRequest(
        profile,
        play=play,
        can=can,
        as_socket=as_socket,
        faults=Faults(flip=flip, drop=drop, garbage=garbage),
        imperfections=RobotImperfections(jitter=jitter, pause_probability=pause),
        seed=seed,
    )
    _serve(serve_zebro(request), request, duration)


@app.command()
def imu(
    profile: Annotated[str, typer.Argument()] = "imu-quaternion-serial",
    as_socket: AsSocket = False,
    flip: Flip = 0.0,
    drop: Drop = 0.0,
    garbage: Garbage = 0.0,
    seed: Seed = 0,
    duration: Duration = None,
) -> None:
    """Simulate an inertial measurement unit on a rocking body."""
    from rig.links.faults import Faults
    from zebro_lab.recording.simulate_stage import TwinRequest, serve_imu

    faults = Faults(flip=flip, drop=drop, garbage=garbage)
    request = TwinRequest(profile, as_socket=as_socket, faults=faults, seed=seed)
    _serve(serve_imu(request), request, duration)


@app.command()
def rig(
    profile: Annotated[str, typer.Argument()] = "rig-board-serial",
    can: Can = None,
    as_socket: AsSocket = False,
    drop: Drop = 0.0,
    seed: Seed = 0,
    duration: Duration = None,
) -> None:
    """Simulate the slip rig; it sweeps slip by itself until it is commanded."""
    from rig.links.faults import Faults
    from zebro_lab.recording.simulate_stage import TwinRequest, serve_rig

    request = TwinRequest(profile, can=can, as_socket=as_socket, faults=Faults(drop=drop),
                          seed=seed)  # fmt: skip
    _serve(serve_rig(request), request, duration)


def _serve(
    serving: "AbstractContextManager[Served]", request: "TwinRequest", duration: float | None
) -> None:
    from zebro_lab.recording.simulate_stage import wait_until
    from zebro_lab.terminal.progress import progress_bar

    with progress_bar() as watcher, serving as served:
        for what, place in served.places.items():
            say(f"SIMULATED {what} ({served.source}), profile {request.profile}: {place}")
        say(f"record it as {served.address}")
        wait_until(watcher.stop_requested, duration=duration)
