# SPDX-License-Identifier: MIT
"""Pictures of studies show a panel for each parameter, failures in red, within the paper."""

import pytest
from matplotlib.colors import to_hex

from support.figure_extents import overhang
from support.made_studies import coverage_of, ranks_of
from zebro_lab.plots.sheet import BLUE, RED
from zebro_lab.study.pictures import draw_coverage, draw_ecdf, draw_ranks

NAMES = ("slip_stiffness", "shape", "friction", "noise_floor", "offset_spread")


@pytest.mark.parametrize("draw", [draw_ranks, draw_ecdf])
def test_each_parameter_has_a_panel_and_a_failure_is_red(draw):
    figure = draw(ranks_of(NAMES, narrow=("friction",)).tests, title="plan 'x'")
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert [title.split("\n")[0] for title in titles] == [n.replace("_", " ") for n in NAMES]
    assert titles[2].endswith("intervals too narrow")
    assert "(simulated)" in figure.get_suptitle()
    drawn = [
        to_hex(
            axes.lines[-1].get_color() if draw is draw_ecdf else axes.patches[-1].get_facecolor()
        )
        for axes in figure.axes
    ]
    assert [colour.upper() for colour in drawn] == [BLUE, BLUE, RED, BLUE, BLUE]
    assert overhang(figure) < 0


def test_the_counts_of_every_bin_are_drawn():
    result = ranks_of(NAMES, narrow=("noise_floor",))
    figure = draw_ranks(result.tests, title="x")
    for axes in figure.axes:
        counts = axes.patches[-1].get_data().values
        assert counts.sum() == result.ranked
        assert counts.max() < axes.get_ylim()[1]


def test_coverage_shows_each_count_and_what_lies_outside():
    covered = coverage_of(NAMES, narrow=("friction",)).covered
    figure = draw_coverage(covered, title="x")
    half, ninety, bias = figure.axes
    points = [float(line.get_xdata()[0]) for line in ninety.lines[1:]]
    assert points == [each.held[1] / each.n for each in covered]
    assert ninety.lines[1:][2].get_color() == RED
    assert half.get_xlabel().startswith("share of 60 intervals\nof 50 %")
    assert list(bias.lines[-1].get_xdata()) == [each.bias for each in covered]
    assert overhang(figure) < 0
