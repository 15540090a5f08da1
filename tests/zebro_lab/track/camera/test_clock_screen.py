# SPDX-License-Identifier: MIT
"""The clock on a terminal can be read by a camera."""

import re

import numpy as np

from zebro_lab.track.camera.clock_screen import code_lines, show_clock


def test_the_clock_on_the_terminal_can_be_read_by_a_camera():
    from tracking.images import read_clock

    cells = {" ": (255, 255), "█": (0, 0), "▀": (0, 255), "▄": (255, 0)}
    lines = re.sub(r"\x1b\[[\d;]*m", "", code_lines(1234567890.5)).splitlines()
    upper = np.array([[cells[c][0] for c in line] for line in lines])
    lower = np.array([[cells[c][1] for c in line] for line in lines])
    code = np.stack((upper, lower), axis=1).reshape(-1, upper.shape[1]).astype(np.uint8)
    assert read_clock(np.kron(code, np.ones((10, 10), np.uint8))) == 1234567890.5


def test_the_clock_runs_until_it_is_stopped(capsys):
    asked = iter((False, False, True))
    show_clock(lambda: next(asked), duration=None)
    assert capsys.readouterr().out.count("photograph this code") == 2
