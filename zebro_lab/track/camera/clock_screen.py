# SPDX-License-Identifier: MIT
"""QR code of the time on a terminal; it opens no window, so it works over a remote shell."""

import time
from collections.abc import Callable

import numpy as np
import typer
from numpy.typing import NDArray

from tracking.images import clock_picture

RENEWAL = 0.1
"""Interval at which the code is renewed; `tracking.images.clock_offset` assumes it [s]."""

_HOME = "\x1b[H"
_CLEAR = "\x1b[2J"


def show_clock(stopped: Callable[[], bool], *, duration: float | None) -> None:
    """Print the QR code of the current time every `RENEWAL` until a stop or for a duration.

    Args:
        stopped: Returns whether a stop was requested.
        duration: Time after which to stop [s]; None for no limit.
    """
    end = None if duration is None else time.monotonic() + duration
    typer.echo(_CLEAR, nl=False)
    while not stopped() and (end is None or time.monotonic() < end):
        now = time.time()
        typer.echo(f"{_HOME}{code_lines(now)}\nphotograph this code; press Ctrl-C to end", nl=True)
        # In phase with the clock itself, so that the code never shows an outdated time.
        time.sleep(RENEWAL - time.time() % RENEWAL)


def code_lines(t: float) -> str:
    """Return the QR code of a moment as text in half-block characters, black on white.

    Each line holds two rows of the code and its own colour codes (ANSI).

    Args:
        t: Time since the Unix epoch [s].
    """
    code = np.asarray(clock_picture(t, module_px=1)) > 127
    if len(code) % 2:
        code = np.vstack((code, np.ones((1, code.shape[1]), dtype=bool)))
    rows = [_line(upper, lower) for upper, lower in zip(code[::2], code[1::2], strict=True)]
    # White ground and black ink, whatever the terminal's own colours are.
    return "\n".join(f"\x1b[30;107m{row}\x1b[0m" for row in rows)


def _line(upper: NDArray[np.bool_], lower: NDArray[np.bool_]) -> str:
    """Join two rows of cells, True where white, into one line of half-block characters."""
    blocks = {(True, True): " ", (False, False): "█", (False, True): "▀", (True, False): "▄"}
    return "".join(blocks[bool(a), bool(b)] for a, b in zip(upper, lower, strict=True))
