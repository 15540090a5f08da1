# SPDX-License-Identifier: MIT
"""Figures of a walk: each draws what the path holds, and says it is simulated."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from model.robot import Robot
from support.figure_extents import overhang
from zebro_lab.plots.walk_legs import (
    gantt,
    leg_angles,
    normal_forces,
    slip_ratios,
    traction_forces,
)
from zebro_lab.plots.walk_path import motion, orientation, path_with_snapshots

FIGURES = {
    "path": partial(path_with_snapshots, robot=Robot()),
    "motion": motion,
    "orientation": orientation,
    "slip_ratio": slip_ratios,
    "normal_force": normal_forces,
    "traction_force": traction_forces,
    "leg_angles": leg_angles,
    "gantt": gantt,
}
draws_all = pytest.mark.parametrize("draw", FIGURES.values(), ids=FIGURES)


@draws_all
def test_a_walk_is_called_simulated_has_units_and_is_drawn_within_the_page(draw, walked):
    figure = draw(walked, title="A walk")
    assert figure.get_suptitle() == "A walk (simulated)"
    assert overhang(figure) <= 0
    if draw is gantt:
        assert figure.axes[0].get_xlabel() == "time [s]"
        return
    labels = [label for a in figure.axes for label in (a.get_xlabel(), a.get_ylabel())]
    labels.append(figure.get_supylabel())
    assert sum("[" in label for label in labels) >= 2


@draws_all
def test_model_without_forces_and_slip_is_drawn_all_the_same(draw, walked):
    bare = replace(
        walked,
        slip_ratio=np.full_like(walked.slip_ratio, np.nan),
        normal_force=np.full_like(walked.normal_force, np.nan),
        traction_force=np.full_like(walked.traction_force, np.nan),
    )
    figure = draw(bare, title="A walk")
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    empty = draw in (slip_ratios, normal_forces, traction_forces)
    assert ("this model computes none" in texts) == empty


@draws_all
def test_standing_robot_is_drawn(draw, walked):
    still = walked.part(np.zeros(50, dtype=int))
    draw(replace(still, t=np.arange(50) * 0.01), title="A walk")
