# SPDX-License-Identifier: MIT
"""`zebro-lab zebro check`: which channel is which leg, which way it turns, where its zero is."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.recording.request import CheckRequest
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from rig.zebro.check import MovedLeg

app = typer.Typer(no_args_is_help=True, help="Work on the robot itself.")


@app.callback()
def zebro() -> None:
    """Work on the robot itself."""


@app.command()
@request_command()
def check(request: CheckRequest) -> None:
    """Fix leg order, signs and zeros; the robot stands on a block, its legs free to turn."""
    from zebro_lab.recording.check_stage import check_zebro

    checked = check_zebro(request, _Terminal())
    if checked.lift_off is not None:
        say(
            f"lift-off at {checked.lift_off.theta_deg:.1f} degrees, hip "
            f"{1e3 * checked.lift_off.mismatch:+.1f} mm from its height at touchdown"
        )
    say(f"wrote {checked.file}; name it as --zebro {checked.file}@PORT")


class _Terminal:
    """Prompts on the terminal; implements the protocol `Person`."""

    def watch(self, channel: int) -> "MovedLeg":
        """Prompt for the leg that moved with a channel (from 0), and for its direction."""
        from rig.zebro.check import MovedLeg

        leg = typer.prompt(
            f"channel {channel + 1} moved; which leg was it (1 to 6)?", value_proc=_leg_number
        )
        return MovedLeg(leg, typer.confirm("did it turn as in walking forward?"))

    def hold_toes_ahead(self) -> None:
        """Ask the person to hold every toe straight ahead, and wait for Enter."""
        typer.prompt(
            "turn every toe straight ahead and hold it; Enter", default="", show_default=False
        )

    def measure_height(self, theta_deg: float) -> float:
        """Prompt for the height of leg 1's hip in mm, leg at `theta_deg`; return it in m."""
        asked = f"leg 1 stands at {theta_deg:.1f} degrees; hip height in mm?"
        return typer.prompt(asked, value_proc=_number) / 1000


def _leg_number(text: str) -> int:
    if text not in {"1", "2", "3", "4", "5", "6"}:
        raise typer.BadParameter(f"found '{text}'; expected 1 to 6")
    return int(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise typer.BadParameter(f"found '{text}'; expected a number") from error
