# SPDX-License-Identifier: MIT
"""A photograph with a grid has the pixels that are read off."""

import numpy as np

from zebro_lab.plots.pixel_grid import pixel_grid

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
