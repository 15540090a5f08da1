# SPDX-License-Identifier: MIT
from model.robot import Robot
from zebro_lab.plots.walk_snapshots import snapshots


def test_each_snapshot_names_its_time_and_the_legs_on_the_ground(walked):
    at = (0.5, 1.0, 1.5, 1.9)
    figure = snapshots(walked, Robot(), title="A walk", at=at)
    assert figure.get_suptitle() == "A walk (simulated)"
    texts = [axes.get_title() for axes in figure.axes]
    for t, text in zip(at, texts, strict=True):
        legs = walked.contact[abs(walked.t - t).argmin()].nonzero()[0] + 1
        assert text == f"t = {t:g} s   {{{', '.join(map(str, legs))}}}".replace("= 1 s", "= 1.0 s")
