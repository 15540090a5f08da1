# SPDX-License-Identifier: MIT
"""A fit of walks has a picture of its parameters, and one of each walk left out."""

from support.drawn_figures import figures_saved
from support.judged_walks import judged_walk
from support.walk_posteriors import posterior_of
from zebro_lab.walk_fit.pictures import draw_walks


def test_parameters_and_each_walk_left_out_are_drawn(tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    left_out = [judged_walk(name, off=0.02) for name in ("one", "two")]
    draw_walks(tmp_path, posterior_of(None), left_out, simulated=True)
    assert set(saved) == {"walk_parameters.png", "left_out.one.png", "left_out.two.png"}
    for figure in saved.values():
        assert "(simulated)" in figure.get_suptitle()
    assert "from a fit of the other walks" in saved["left_out.two.png"].get_suptitle()
    above = saved["left_out.one.png"].axes[0]
    assert above.lines[-1].get_ydata().tolist() == [0.02] * 9
    assert len(above.lines) == 41 + 1 + 1  # draws, prediction, track
