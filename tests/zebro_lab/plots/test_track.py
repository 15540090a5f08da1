# SPDX-License-Identifier: MIT
"""Pictures of a track have the scale, the direction and the honesty they should."""

import numpy as np
import pytest

from zebro_lab.plots.sheet import save
from zebro_lab.plots.track import SeenMarks, over_floor, over_photo, residual_page

PIXELS = np.full((90, 120, 3), 200, np.uint8)
POSES = np.array([[0.0, 0, 0], [0.5, 0.1, 0.2], [np.nan] * 3, [1.5, 0.6, 0.6]])
MARK = SeenMarks([np.array([[10.0, 10], [20, 10], [20, 20], [10, 20]])], ["10"], "mark", "blue")


def floor(simulated: bool = True):
    return over_floor(
        PIXELS, extent=(-1.0, 2.0, -1.0, 1.25), poses=POSES, ellipses=[POSES[:2, :2]],
        labels=["0 s", "2 s", "", "9 s"], title="Path", note="at 9 s", simulated=simulated,
    )  # fmt: skip


def photograph(simulated: bool = True):
    path = np.array([[10.0, 10], [50, 40]])
    return over_photo(
        PIXELS, title="Path", simulated=simulated, path_px=path, headings_px=path + 5, marks=[MARK]
    )


def residuals(simulated: bool = True):
    n = 5
    return residual_page(
        np.arange(n), np.zeros((n, 3)), sd=np.ones((n, 3)), score=np.ones(n), height=np.ones(n),
        source=["marker", "hand", "marker", "body", "marker"], title="Residuals",
        simulated=simulated,
    )  # fmt: skip


@pytest.mark.parametrize("draw", [floor, photograph, residuals])
def test_what_is_simulated_says_so_and_what_is_not_does_not(draw, tmp_path):
    assert "(simulated)" in draw().get_suptitle()
    assert "simulated" not in draw(simulated=False).get_suptitle()
    for name in ("a.png", "b.png"):
        save(draw(), tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_the_floor_has_y_up_and_one_scale():
    (axes,) = floor().axes
    assert axes.get_xlim() == (-1.0, 2.0)
    assert axes.get_ylim() == (-1.0, 1.25)
    assert axes.get_aspect() == 1.0


def test_no_line_crosses_a_gap():
    (axes,) = floor().axes
    path = axes.get_lines()[0].get_xydata()
    assert np.isnan(path[2]).all()


def test_the_photograph_has_v_down_and_half_a_pixel_around_it():
    (axes,) = photograph().axes
    assert axes.get_xlim() == (-0.5, 119.5)
    assert axes.get_ylim() == (89.5, -0.5)
