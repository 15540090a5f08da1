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
from zebro_lab.plots import (
    parameter_labels,
    save,
)
from zebro_lab.plots.sheet import legend_below, new_figure, slip_grid


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
    save(new_figure("", simulated=False, width=2.0, height=1.0), tmp_path / "a", command=command)
    with Image.open(tmp_path / "a") as image:
        assert (image.format, image.size) == ("PNG", (300, 150))
        assert image.text.get("Comment") == command
