# SPDX-License-Identifier: MIT
"""Figures of a walk: each draws what the path holds, and says it is simulated."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from model.robot import Robot
from zebro_lab.plots import save
from zebro_lab.plots.walk_legs import (
    gantt,
    normal_forces,
    paired_traction,
    slip_ratios,
    stances,
    traction_forces,
)
from zebro_lab.plots.walk_path import motion, orientation, path_with_snapshots
from zebro_lab.walk.folder import PICTURES
from zebro_lab.walk.pictures import draw_walk, last_cycles

FIGURES = {
    "path": partial(path_with_snapshots, robot=Robot()),
    "motion": motion,
    "orientation": orientation,
    "slip_ratio": slip_ratios,
    "normal_force": normal_forces,
    "traction_force": traction_forces,
    "paired_traction": paired_traction,
    "gantt": gantt,
}
draws_all = pytest.mark.parametrize("draw", FIGURES.values(), ids=FIGURES)


@draws_all
def test_a_walk_is_called_simulated_in_its_title(draw, walked):
    assert draw(walked, title="A walk").get_suptitle() == "A walk (simulated)"


@draws_all
def test_every_axis_has_a_unit(draw, walked):
    figure = draw(walked, title="A walk")
    if draw is gantt:
        assert figure.axes[0].get_xlabel() == "time [s]"
        return
    labels = [label for a in figure.axes for label in (a.get_xlabel(), a.get_ylabel())]
    labels.append(figure.get_supylabel())
    assert sum("[" in label for label in labels) >= 2


@draws_all
def test_same_walk_is_drawn_to_the_same_bytes(draw, walked, tmp_path):
    for name in ("a", "b"):
        save(draw(walked, title="A walk"), tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


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
    empty = draw in (slip_ratios, normal_forces, traction_forces, paired_traction)
    assert ("this model computes none" in texts) == empty


@draws_all
def test_standing_robot_is_drawn(draw, walked):
    still = walked.part(np.zeros(50, dtype=int))
    draw(replace(still, t=np.arange(50) * 0.01), title="A walk")


def test_snapshots_show_the_body_where_it_is(walked):
    figure = path_with_snapshots(walked, Robot(), title="A walk")
    axes = figure.axes[0]
    assert axes.get_aspect() == 1.0
    bodies = [patch.get_path().vertices for patch in axes.patches]
    assert len(bodies) == 6
    for body, index in zip(bodies[::5], (0, -1), strict=True):
        middle = (body.min(axis=0) + body.max(axis=0)) / 2
        np.testing.assert_allclose(middle, walked.position[index, :2], atol=0.03)


def test_legs_are_where_they_are_on_the_robot(walked):
    figure = normal_forces(walked, title="A walk")
    names = [axes.get_title(loc="left") for axes in figure.axes]
    assert names[0] == "leg 1, left front"
    assert names[5] == "leg 6, right rear"
    for leg, axes in enumerate(figure.axes):  # the first line is zero
        np.testing.assert_array_equal(axes.lines[1].get_ydata(), walked.normal_force[:, leg])


@given(arrays(bool, st.integers(1, 30)))
def test_stances_are_where_the_contact_is(contact):
    t = np.arange(float(len(contact)))
    found = np.zeros(len(contact), dtype=bool)
    for start, end in stances(t, contact):
        found[(t >= start) & ((t < end) | ((t == t[-1]) & (end == t[-1]) & contact[-1]))] = True
    np.testing.assert_array_equal(found, contact)


def test_paired_traction_leaves_nothing_of_what_alternates(walked):
    sign = np.where(np.arange(len(walked.t)) % 2 == 0, 5.0, -5.0)[:, None, None]
    chatter = replace(walked, traction_force=walked.traction_force + sign)
    for axes, noisy in zip(
        *(paired_traction(p, title="").axes for p in (walked, chatter)), strict=True
    ):
        np.testing.assert_allclose(axes.lines[1].get_ydata(), noisy.lines[1].get_ydata(), atol=1e-9)


@given(period=st.none() | st.floats(0.05, 10))
def test_last_cycles_end_with_the_walk(period, walked):
    end = last_cycles(walked, period)
    asked = 4.0 if period is None else 2 * period
    assert end.t[-1] == walked.t[-1]
    assert end.t[-1] - end.t[0] == pytest.approx(min(asked, 4.0), abs=0.011)


def test_folder_gets_every_picture(walked, tmp_path):
    draw_walk(tmp_path, walked, Robot(), title="tripod, dynamics", period=2.0)
    assert {p.name for p in tmp_path.iterdir()} == {f"{name}.png" for name in PICTURES}
    for path in tmp_path.iterdir():
        with Image.open(path) as image:
            assert np.asarray(image.convert("L")).std() > 5  # something is drawn
