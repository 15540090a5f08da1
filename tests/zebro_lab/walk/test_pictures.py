# SPDX-License-Identifier: MIT
"""A walk folder has every picture, of the end of the walk where it is steady."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from model.robot import Robot
from zebro_lab.walk.folder import PICTURES
from zebro_lab.walk.pictures import draw_walk, last_cycles


@given(period=st.none() | st.floats(0.05, 10))
def test_last_cycles_end_with_the_walk(period, walked):
    end = last_cycles(walked, period)
    asked = 4.0 if period is None else 2 * period
    assert end.t[-1] == walked.t[-1]
    assert end.t[-1] - end.t[0] == pytest.approx(min(asked, 4.0), abs=0.011)


def test_folder_gets_every_picture(walked, tmp_path):
    draw_walk(tmp_path, walked, Robot(), title="tripod, dynamics", period=2.0)
    assert {p.name for p in tmp_path.iterdir()} == {f"{name}.png" for name in PICTURES}
    for path in tmp_path.iterdir():
        with Image.open(path) as image:
            assert np.asarray(image.convert("L")).std() > 5  # something is drawn
