# SPDX-License-Identifier: MIT
"""What a track prints."""

from zebro_lab.track.screen import track_lines


def test_a_track_is_summed_up_in_lines_that_hold_no_line_breaks(usual):
    lines = track_lines(usual)
    assert lines[0].startswith("SIMULATED track ")
    assert f"written to {usual.folder}:" in lines
    assert not any("\n" in line for line in lines)
