# SPDX-License-Identifier: MIT
"""Pictures of a track have the scale, the direction and the honesty they should."""

import numpy as np
import pytest

from zebro_lab.plots.sheet import save
from zebro_lab.plots.track import SeenMarks, over_floor, over_photo, pixel_grid, residual_page

PIXELS = np.full((90, 120, 3), 200, np.uint8)


def test_a_part_of_a_photograph_is_drawn_enlarged_and_cut_at_its_edge():
    (axes,) = pixel_grid(PIXELS, title="p", around=(5, 50), reach=20).axes
    assert axes.get_xlim() == (-0.5, 25.0)
    assert axes.get_ylim() == (70.0, 30.0)


def test_the_whole_photograph_is_shown_in_its_colours_with_its_first_pixel_at_zero():
    pixels = PIXELS.copy()
    pixels[0, 0] = (10, 20, 30)  # blue, green, red
    (axes,) = pixel_grid(pixels, title="p01.jpg").axes
    assert axes.get_xlim() == (-0.5, 119.5)
    assert axes.get_ylim() == (89.5, -0.5)
    assert axes.images[0].get_array()[0, 0].tolist() == [30, 20, 10]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("u [px]", "v [px]")
    assert axes.get_figure().get_suptitle() == "p01.jpg"


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


def test_the_floor_has_y_up_to_one_scale_and_the_photograph_v_down():
    (axes,) = photograph().axes
    assert (axes.get_xlim(), axes.get_ylim()) == ((-0.5, 119.5), (89.5, -0.5))
    (axes,) = floor().axes
    assert (axes.get_xlim(), axes.get_ylim()) == ((-1.0, 2.0), (-1.0, 1.25))
    assert axes.get_aspect() == 1.0
    path = axes.get_lines()[0].get_xydata()
    assert np.isnan(path[2]).all()
