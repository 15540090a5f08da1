# SPDX-License-Identifier: MIT
from model.robot import Robot
from support.figure_extents import overhang
from zebro_lab.plots.walk_snapshots import snapshots


def test_each_snapshot_names_its_time_and_the_legs_on_the_ground(walked):
    at = (0.5, 1.0, 1.5, 1.9)
    figure = snapshots(walked, Robot(), title="A walk", at=at)
    assert figure.get_suptitle() == "A walk (simulated)"
    texts = [axes.get_title() for axes in figure.axes]
    for t, text in zip(at, texts, strict=True):
        legs = walked.contact[abs(walked.t - t).argmin()].nonzero()[0] + 1
        assert text == f"t = {t:g} s   {{{', '.join(map(str, legs))}}}".replace("= 1 s", "= 1.0 s")


def test_without_times_six_are_drawn(walked):
    assert len(snapshots(walked, Robot(), title="A walk").axes) == 6


def test_one_snapshot_has_room_for_its_title(walked):
    figure = snapshots(walked, Robot(), title="A walk of a robot by some model", at=(1.0,))
    (axes,) = figure.axes
    axes.set_visible(False)  # 3-D axes reach beyond the page by intent
    assert overhang(figure) <= 0
