# SPDX-License-Identifier: MIT
"""Figures have one style, whatever the style of the user."""

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import pyplot as plt
from PIL import Image

from model.slip import MagicFormula
from zebro_lab.files.picture_format import FORMATS
from zebro_lab.plots import (
    add_to_title,
    parameter_labels,
    save,
)
from zebro_lab.plots.sheet import legend_below, new_figure, slip_grid, time_texts, tint


def test_no_figure_is_left_with_pyplot(one_load, tmp_path):
    figures = [one_load.picture(name) for name in ("curves", "surface")]
    save(figures[0], tmp_path / "curves.png")
    assert plt.get_fignums() == []


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


def test_labels_spell_name_symbol_and_unit():
    law = MagicFormula("constant", load_sensitivity=True)
    assert parameter_labels(law.parameters)[2] == "friction\n${\\mu}$ [-]"
    assert parameter_labels(law.parameters)[4] == "friction load exponent\n$a_{\\mu}$ [-]"


def test_the_legend_has_every_label_of_all_panels_once():
    figure = new_figure("Two", simulated=True, width=4.0, height=3.0)
    for axes in figure.subplots(1, 2):
        axes.plot([0, 1], [0, 1], label="same")
        axes.plot([0, 1], [1, 0], label=f"own {len(figure.axes)}")
        axes.plot([0, 1], [0, 0])
    legend_below(figure, columns=2)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["same", "own 2"]
    assert figure.get_suptitle() == "Two (simulated)"


@pytest.mark.parametrize("command", [None, "plot"])
def test_a_picture_names_the_command_that_draws_it(command, tmp_path):
    file = tmp_path / "a.png"
    save(new_figure("", simulated=False, width=2.0, height=1.0), file, command=command)
    with Image.open(file) as image:
        assert (image.format, image.size) == ("PNG", (300, 150))
        assert image.text.get("Comment") == command


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


def test_an_svg_needs_no_font(tmp_path):
    save(new_figure("Fonts", simulated=False, width=3.0, height=2.0), tmp_path / "a.svg")
    assert "<text" not in (tmp_path / "a.svg").read_text()


def test_a_long_title_is_wrapped_to_the_figure():
    figure = new_figure("a walk of many words " * 8, simulated=True, width=4.0, height=3.0)
    figure.draw_without_rendering()
    assert figure._suptitle.get_window_extent().width <= figure.bbox.width


def test_tints_are_opaque_between_white_and_blue():
    shares = [int(tint(share)[1:3], 16) for share in (0.0, 0.3, 0.6, 1.0)]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] == 255


def test_times_are_told_apart_with_the_fewest_decimals():
    assert time_texts(np.array([0.00201, 6.0, 12.0])) == ["0", "6", "12"]
    assert time_texts(np.array([0.5, 1.25])) == ["0.50", "1.25"]
    assert time_texts(np.array([-0.0001, 1.0])) == ["0", "1"]
    assert time_texts(np.array([0.0, 2.4, 4.8])) == ["0.0", "2.4", "4.8"]
    assert time_texts(np.array([1.0, 1.0])) == ["1", "1"]


def test_a_long_title_is_broken_after_its_colon():
    figure = new_figure(
        "Traction: tripod, steering 1.3, thesis", simulated=True, width=4.5, height=3.0
    )
    assert figure.get_suptitle() == "Traction:\ntripod, steering 1.3, thesis (simulated)"
    add_to_title(figure, "NOT TRUSTWORTHY")
    assert figure.get_suptitle().replace("\n", " ") == (
        "Traction: tripod, steering 1.3, thesis (simulated): NOT TRUSTWORTHY"
    )
