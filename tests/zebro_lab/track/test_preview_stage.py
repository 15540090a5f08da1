# SPDX-License-Identifier: MIT
"""The first photograph alone shows what is found, and checks the tape."""

import pytest

from zebro_lab.track.preview_stage import preview


def test_the_preview_compares_tape_and_photograph(request_, tmp_path):
    file = tmp_path / "preview.png"
    seen = preview(request_, file)
    assert file.read_bytes()[:4] == b"\x89PNG"
    assert seen.marks == ("10", "11", "12", "13")
    assert len(seen.tape) == 6
    assert not any(check.is_off for check in seen.tape)
    assert seen.robot == pytest.approx((0, 0, 0), abs=3e-3)
    assert 1e-3 < seen.scale < 4e-3
