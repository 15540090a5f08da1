# SPDX-License-Identifier: MIT

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from support.figure_extents import overhang
from zebro_lab.plots import (
    save,
)

PICTURES = ("curves", "surface", "corner", "traces", "residuals")


def texts(figure: Figure) -> str:
    """Everything the axes of a figure are labelled with."""
    labels = []
    for axes in figure.axes:
        labels += [axes.get_xlabel(), axes.get_ylabel()]
        labels += [axes.get_zlabel()] if hasattr(axes, "get_zlabel") else []
    return "\n".join(labels)


@pytest.mark.parametrize("picture", PICTURES)
def test_every_picture_ends_as_a_png_of_page_size(rig, tmp_path, picture):
    path = tmp_path / f"{picture}.png"
    save(rig.picture(picture), path)
    with Image.open(path) as image:
        assert image.format == "PNG"
        assert image.text == {"Software": "zebro-lab"}
        assert all(700 <= side <= 2000 for side in image.size)
        assert image.info["dpi"] == pytest.approx((150, 150), abs=0.1)
        assert np.asarray(image.convert("L")).std() > 10


def test_units_stand_on_every_axis_that_is_labelled(any_scene):
    for name in PICTURES:
        figure = any_scene.picture(name)
        labels = [label for label in texts(figure).splitlines() if label]
        assert labels, name
        assert all("[" in text for axes in figure.axes if (text := axes.get_xlabel())), name
        assert all("[" in text for axes in figure.axes if (text := axes.get_ylabel())), name


@pytest.mark.parametrize("picture", PICTURES)
def test_nothing_is_drawn_beyond_the_page(rig, picture):
    assert overhang(rig.picture(picture)) <= 0


def test_the_slip_axis_names_its_definition(tyre):
    labels = {name: texts(tyre.picture(name)) for name in PICTURES}
    for name in ("curves", "surface", "residuals"):
        assert "slip ratio, travel definition [-]" in labels[name]


def test_simulated_pictures_say_so_and_measured_ones_do_not(one_load):
    for name in PICTURES:
        title = one_load.picture(name, simulated=False).get_suptitle()
        assert one_load.picture(name, simulated=True).get_suptitle() == f"{title} (simulated)"
