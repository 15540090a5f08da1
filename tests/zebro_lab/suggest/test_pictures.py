# SPDX-License-Identifier: MIT
"""The picture shows the curve with both bands, and the chosen slips by their number."""

import numpy as np
import pytest

from support.suggestions import suggested
from zebro_lab.suggest.pictures import draw_suggested


@pytest.fixture
def figure(monkeypatch, tmp_path):
    """Return the figure that is drawn of a suggestion."""
    drawn = []
    monkeypatch.setattr("zebro_lab.plots.save", lambda figure, _: drawn.append(figure))
    draw_suggested(tmp_path / "x.png", suggested())
    return drawn[0]


def test_each_end_of_the_loads_has_the_whole_and_the_part_near_zero(figure):
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == ["load 3 N", "near zero slip", "load 9 N", "near zero slip"]
    assert "Suggested points for slip_stiffness" in figure.get_suptitle().replace("\n", " ")
    assert figure.get_suptitle().endswith("(simulated)")


def test_the_band_after_is_inside_the_band_now(figure):
    now, after = figure.axes[0].collections[:2]
    heights = [np.ptp(each.get_paths()[0].vertices[:, 1]) for each in (now, after)]
    assert heights[1] <= heights[0]


def test_slips_are_marked_larger_where_there_are_more(figure):
    proposal = suggested().proposal
    marks = figure.axes[0].collections[2]
    assert np.asarray(marks.get_offsets())[:, 0] == pytest.approx(proposal.slips)
    order = np.argsort(proposal.counts)
    assert np.all(np.diff(marks.get_sizes()[order]) >= 0)
    texts = [[text.get_text() for text in axes.texts] for axes in figure.axes[:2]]
    near = np.abs(proposal.slips) <= 0.12  # 15 % of the largest slip
    several = proposal.counts > 1
    assert texts[0] == [str(n) for n in proposal.counts[several & ~near]]
    assert texts[1] == [str(n) for n in proposal.counts[several & near]]
