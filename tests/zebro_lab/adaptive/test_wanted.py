# SPDX-License-Identifier: MIT
from pathlib import Path

import pytest
from typer import BadParameter

from zebro_lab.adaptive.wanted import parse_wanted
from zebro_lab.suggest.target_text import ForceText, WalkText


def test_target_and_half_width_are_read_apart():
    found = parse_wanted("force@0.02,0.2:8=0.05")
    assert (found.text, found.half_width) == ("force@0.02,0.2:8", 0.05)
    assert found.target == ForceText((0.02, 0.2), 8.0)
    assert parse_wanted("friction").half_width is None


def test_a_walk_may_have_an_equals_sign_in_its_path():
    assert parse_wanted("walk:a=1").target == WalkText(Path("a=1"))


@pytest.mark.parametrize("text", ["friction=", "friction=0", "friction=-1", "friction=nan", "=1"])
def test_a_width_that_is_none_is_refused(text):
    with pytest.raises(BadParameter, match=r"expected|is no target"):
        parse_wanted(text)
