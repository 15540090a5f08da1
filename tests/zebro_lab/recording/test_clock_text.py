# SPDX-License-Identifier: MIT
"""A clock is told with as many digits as are known, and not at all where too little is."""

from rig.clock_fit import DRIFT_SD
from zebro_lab.recording.clock_text import clock_in_words

CLOCK = {"offset": 0.0017331, "drift": -3.2443e-4, "delay": 0.00408, "offset_sd": 2.5e-4,
         "drift_sd": 2.05e-5}  # fmt: skip


def test_a_clock_is_told_with_its_uncertainty():
    text = clock_in_words("legs", CLOCK)
    assert "clock of legs: runs 324 ± 41 ppm faster than this computer's" in text
    assert "shows 0 s at 0.00173 ± 0.00050 s of the run" in text
    assert "more than 4.1 ms late" in text


def test_a_clock_seen_for_a_moment_is_not_testable():
    moment = CLOCK | {"drift_sd": DRIFT_SD}
    assert "not testable in so short a time" in clock_in_words("imu", moment)
    assert "ppm" not in clock_in_words("imu", moment)
