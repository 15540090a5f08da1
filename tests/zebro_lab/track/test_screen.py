# SPDX-License-Identifier: MIT
"""What a track prints."""

from support.bundled_walk import Nobody
from zebro_lab.track.screen import track_lines
from zebro_lab.track.stage import track


def test_a_track_is_summed_up_in_lines_that_hold_no_line_breaks(request_, undrawn):
    result = track(request_, Nobody())
    lines = track_lines(result)
    assert lines[0].startswith("SIMULATED track ")
    assert f"written to {result.folder}:" in lines
    assert not any("\n" in line for line in lines)
