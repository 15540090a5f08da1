# SPDX-License-Identifier: MIT
"""`zebro-lab camera` as its user meets it."""

import re

from support.bundled_walk import WALK


def test_a_board_is_calibrated_and_coverage_shown(run_command, tmp_path):
    code, out, _ = run_command(
        "camera", "calibrate", WALK / "calibration", "--board", "charuco:9x6:40mm:30mm:4x4_50",
        "--out", tmp_path / "camera.toml",
    )  # fmt: skip
    assert code == 0
    assert re.search(r"fx 150\d\.\d\d ± 0\.\d\d px", out)
    assert "  # # # # # # # #\n" in out
    assert (tmp_path / "camera.toml").is_file()


def test_the_clock_runs_and_ends_by_itself(run_command):
    code, out, _ = run_command("camera", "clock", "--duration", "0.25")
    assert code == 0
    assert out.count("photograph this code") >= 2
