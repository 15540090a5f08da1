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
