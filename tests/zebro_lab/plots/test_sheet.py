# SPDX-License-Identifier: MIT
"""Figures have one style, whatever the style of the user."""

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from support.calibration_scenes import SCREEN
from support.figure_extents import overhang, overlapping_texts
from zebro_lab.files.picture_format import FORMATS
from zebro_lab.plots.sheet import Page, finish, new_figure, save, slip_grid

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
    figure = rig.picture(picture)
    assert overhang(figure) <= 0
    save(figure, path)
    with Image.open(path) as image:
        assert image.format == "PNG"
        assert image.text == {"Software": "zebro-lab"}
        assert all(700 <= side <= 2000 for side in image.size)
        assert image.info["dpi"] == pytest.approx((150, 150), abs=0.1)
        assert np.asarray(image.convert("L")).std() > 10


def test_units_stand_on_every_axis_that_is_labelled(few):
    for name in PICTURES:
        figure = few.picture(name)
        assert texts(figure).strip(), name
        for axes in figure.axes:
            assert all("[" in text for text in (axes.get_xlabel(), axes.get_ylabel()) if text), name


def test_the_slip_axis_names_its_definition(tyre):
    for name in ("curves", "surface", "residuals"):
        assert "slip ratio, travel definition [-]" in texts(tyre.picture(name))


def test_simulated_pictures_say_so_and_measured_ones_do_not(one_load):
    for name in PICTURES:
        title = one_load.picture(name, Page(simulated=False)).get_suptitle()
        assert one_load.picture(name, SCREEN).get_suptitle() == f"{title} (simulated)"


@pytest.mark.parametrize("picture", PICTURES)
def test_printed_pictures_are_legible_and_nothing_overlaps(rig, one_load, picture):
    for scene, width, titled in ((rig, 84 / 25.4, False), (one_load, 174 / 25.4, True)):
        figure = scene.picture(picture, Page(simulated=True, width=width))
        finish(figure, "SIMULATED data; verdict: not fully tested", titled=titled)
        assert figure.get_figwidth() == width
        assert bool(figure.get_suptitle()) is titled
        assert overhang(figure) <= 0
        assert not overlapping_texts(figure)
        sizes = {text.get_fontsize() for text in figure.findobj(Text) if text.get_text()}
        assert 7.0 <= min(sizes) <= max(sizes) <= 9.0


def test_the_users_style_neither_shows_nor_changes(one_load, tmp_path):
    save(one_load.curves(), tmp_path / "plain.png")
    mine = {"font.size": 30.0, "lines.marker": "x", "savefig.bbox": "tight", "axes.grid": True}
    with mpl.rc_context(mine):
        save(one_load.curves(), tmp_path / "styled.png")
        assert {key: mpl.rcParams[key] for key in mine} == mine
    assert (tmp_path / "plain.png").read_bytes() == (tmp_path / "styled.png").read_bytes()


@given(
    low=st.floats(-2, 0.5), width=st.floats(0.01, 3), count=st.integers(5, 50)
)  # fmt: skip
def test_the_slip_grid_spans_the_tested_slip_and_no_more(low, width, count):
    grid = slip_grid(np.array([low, low + width]), count)
    assert grid[0] == low
    assert grid[-1] == low + width
    assert np.all(np.diff(grid) > 0)
    assert np.diff(grid).max() <= 1.01 * width / (count - 1)


@pytest.mark.parametrize("form", FORMATS)
def test_a_picture_has_the_format_of_its_suffix_and_always_the_same_bytes(form, tmp_path):
    files = [tmp_path / f"{name}.{form}" for name in ("a", "b")]
    for file in files:
        figure = new_figure("Two µm", simulated=True, width=3.0, height=2.0)
        figure.add_subplot().plot([0, 1], [1, 0])
        save(figure, file, command="plot")
    one, other = (file.read_bytes() for file in files)
    assert one == other
    assert one.lstrip().startswith({"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[form])
    assert b"atplotlib v" not in one


def test_a_pdf_has_its_fonts_inside_as_truetype(tmp_path):
    figure = new_figure("Fonts", simulated=False, width=3.0, height=2.0)
    save(figure, tmp_path / "a.pdf")
    content = (tmp_path / "a.pdf").read_bytes()
    assert b"/FontFile2" in content
    assert b"/Type3" not in content
