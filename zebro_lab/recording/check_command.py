# SPDX-License-Identifier: MIT
"""`zebro-lab zebro check`: which channel is which leg, which way it turns, where its zero is."""

import io
import math
import select
import sys
from typing import TYPE_CHECKING

import typer

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.source_names import is_simulated
from zebro_lab.recording.request import CheckRequest
from zebro_lab.terminal.command_classes import Application
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from zebro_lab.recording.check_stage import Checked

app = Application(no_args_is_help=True)
_LEGS = "1 to 6: left 1, 3, 5 and right 2, 4, 6, from the front"


@app.callback()
def zebro() -> None:
    """Find leg order, turning directions and zeros of a connected robot."""


@app.command()
@request_command()
def check(request: CheckRequest, output: Output = TEXT) -> None:
    """Move each leg, ask which one moved and which way, and write the robot's leg profile.

    Put the robot on a block first, so that its legs turn freely.
    """
    from zebro_lab.recording.check_stage import check_zebro

    _require_answers()
    checked = check_zebro(request, _Terminal(output))
    if checked.lift_off is not None:
        theta_deg = math.degrees(checked.lift_off.theta)
        output.say(
            f"lift-off angle {theta_deg:.1f} degrees (0 ahead, 90 down): the hip "
            f"height there minus that at touchdown is {1e3 * checked.lift_off.mismatch:+.1f} mm"
        )
    output.say(f"wrote the profile {checked.file}; record with --zebro {checked.file}@PORT")
    output.document("zebro check", _in_numbers(checked))


def _require_answers() -> None:
    """Raise `SettingsError` where standard input has ended already, before a leg is moved."""
    try:
        readable = bool(select.select([sys.stdin], [], [], 0)[0]) and not sys.stdin.isatty()
        given = sys.stdin.buffer
        ended = readable and isinstance(given, io.BufferedReader) and not given.peek(1)
    except (AttributeError, OSError, TypeError, ValueError):  # no file, as in tests, or Windows
        ended = sys.stdin is None
    if ended:
        raise SettingsError(
            "standard input has ended, but the check asks which leg has moved; run it at a "
            "terminal, or pass it all answers, one a line"
        )


def _in_numbers(checked: "Checked") -> dict[str, object]:
    """Return the result of a check for `--json`; keys end in the unit.

    `lift_off` is None if no touchdown angle was given.
    """
    profile, found = checked.profile, checked.lift_off
    lift_off = found and {
        "angle_rad": found.theta, "height_difference_m": found.mismatch
    }  # fmt: skip
    return {
        "simulated": is_simulated(checked.source),
        "written": [checked.file],
        "legs": profile.legs,
        "signs": profile.sign,
        "zero_counts": profile.zero_counts,
        "counts_per_revolution": profile.counts_per_revolution,
        "lift_off": lift_off,
    }


class _Terminal:
    """Prompts on the terminal; implements the protocol `Person`."""

    def __init__(self, output: Output) -> None:
        self._output = output

    def watch(self, channel: int) -> tuple[int, bool]:
        """Prompt for the leg that moved with a channel (from 0), and for its direction."""
        asked = f"channel {channel + 1} was moved; which leg turned ({_LEGS})?"
        with self._output.asking():
            leg = typer.prompt(asked, value_proc=_leg_number)
            return leg, typer.confirm("did that leg turn as in walking forward?")

    def hold_toes_ahead(self) -> None:
        """Ask the person to hold every toe straight ahead, and wait for Enter."""
        text = "turn all toes straight ahead, hold them there and press Enter"
        with self._output.asking():
            typer.prompt(text, default="", show_default=False)

    def measure_height(self, theta_deg: float) -> float:
        """Prompt for the height of leg 1's hip in mm, leg at `theta_deg`; return it in m."""
        asked = f"legs are at {theta_deg:.1f} degrees; height of leg 1's hip above ground [mm]?"
        with self._output.asking():
            return typer.prompt(asked, type=float) / 1000


def _leg_number(text: str) -> int:
    """Parse the number of a leg, 1 to 6; raise `BadParameter` for anything else."""
    if text not in {"1", "2", "3", "4", "5", "6"}:
        raise typer.BadParameter(f"found '{text}'; expected {_LEGS}")
    return int(text)
