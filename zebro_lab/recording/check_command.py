# SPDX-License-Identifier: MIT
"""`zebro-lab zebro check`: which channel is which leg, which way it turns, where its zero is."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.recording.request import CheckRequest
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from rig.zebro.check import MovedLeg

app = Application(no_args_is_help=True)
_LEGS = "1 to 6: left 1, 3, 5 and right 2, 4, 6, from the front"


@app.callback()
def zebro() -> None:
    """Find leg order, turning directions and zeros of a connected robot."""


@app.command()
@request_command()
def check(request: CheckRequest) -> None:
    """Move each leg, ask which one moved and which way, and write the robot's leg profile.

    Put the robot on a block first, so that its legs turn freely.
    """
    from zebro_lab.recording.check_stage import check_zebro

    checked = check_zebro(request, _Terminal())
    if checked.lift_off is not None:
        say(
            f"lift-off angle {checked.lift_off.theta_deg:.1f} degrees (0 ahead, 90 down): the hip "
            f"height there minus that at touchdown is {1e3 * checked.lift_off.mismatch:+.1f} mm"
        )
    say(f"wrote the profile {checked.file}; record with --zebro {checked.file}@PORT")


class _Terminal:
    """Prompts on the terminal; implements the protocol `Person`."""

    def watch(self, channel: int) -> "MovedLeg":
        """Prompt for the leg that moved with a channel (from 0), and for its direction."""
        from rig.zebro.check import MovedLeg

        asked = f"channel {channel + 1} was moved; which leg turned ({_LEGS})?"
        leg = typer.prompt(asked, value_proc=_leg_number)
        return MovedLeg(leg, typer.confirm("did that leg turn as in walking forward?"))

    def hold_toes_ahead(self) -> None:
        """Ask the person to hold every toe straight ahead, and wait for Enter."""
        text = "turn all toes straight ahead, hold them there and press Enter"
        typer.prompt(text, default="", show_default=False)

    def measure_height(self, theta_deg: float) -> float:
        """Prompt for the height of leg 1's hip in mm, leg at `theta_deg`; return it in m."""
        asked = f"legs are at {theta_deg:.1f} degrees; height of leg 1's hip above ground [mm]?"
        return typer.prompt(asked, type=float) / 1000


def _leg_number(text: str) -> int:
    if text not in {"1", "2", "3", "4", "5", "6"}:
        raise typer.BadParameter(f"found '{text}'; expected {_LEGS}")
    return int(text)
