# SPDX-License-Identifier: MIT
"""`zebro-lab camera` as its user meets it."""

import json
import re

from support.bundled_walk import WALK


def test_a_board_is_calibrated_and_coverage_shown_beside_the_document(run_command, tmp_path):
    ended = run_command(
        "camera", "calibrate", WALK / "calibration", "--board", "charuco:9x6:40mm:30mm:4x4_50",
        "--out", tmp_path / "camera.toml", "--json",
    )  # fmt: skip
    assert ended.code == 0
    assert re.search(r"fx 150\d\.\d\d ± 0\.\d\d px", ended.err)
    assert "  # # # # # # # #\n" in ended.err
    assert (tmp_path / "camera.toml").is_file()
    found = json.loads(ended.out)
    assert found.keys() == {
        "command", "exit_code", "written", "lens_model", "size_px", "matrix_px", "distortion",
        "rms_px", "coverage", "photographs", "left_out", "warnings",
    }  # fmt: skip
    assert 1490 < found["matrix_px"][0][0] < 1510
    assert 0 < found["coverage"] <= 1


def test_the_clock_runs_and_ends_by_itself(run_command):
    code, out, _ = run_command("camera", "clock", "--duration", "0.25")
    assert code == 0
    assert out.count("photograph this code") >= 2
