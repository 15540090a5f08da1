# SPDX-License-Identifier: MIT
"""Figures of the thesis's model: each draws what the path holds, in units, on its page."""

from dataclasses import replace

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.thesis.legs import SwitchedLegs
from model.thesis.walk import walk_thesis
from support.figure_extents import overhang
from zebro_lab.plots.walk_thesis import (
    contact_velocities,
    coordinates,
    hip_heights,
    lowest_angles,
    static_loads,
)

FIGURES = (coordinates, lowest_angles, hip_heights, contact_velocities, static_loads)
GAIT = tripod_reference(tripod_angles(np.radians(45.0), 1.2), 1.0)


@pytest.fixture(scope="module")
def path():
    whole = walk_thesis(Robot(), SwitchedLegs.of(GAIT), duration=2.0)
    return whole.part(whole.t >= 1.0)


@pytest.mark.parametrize("draw", FIGURES)
def test_figures_are_called_simulated_and_stay_on_their_page(draw, path):
    figure = draw(path, title="A walk")
    assert figure.get_suptitle() == "A walk (simulated)"
    assert overhang(figure) <= 0
    labels = [label for a in figure.axes for label in (a.get_xlabel(), a.get_ylabel())]
    assert sum("[" in label for label in [*labels, figure.get_supylabel()]) >= 2


def test_coordinates_are_those_of_the_model_in_degrees(path):
    axes = coordinates(path, title="A walk").axes
    drawn = [each.lines[0].get_ydata() for each in axes[:6]]
    np.testing.assert_array_equal(drawn[0], path.position[:, 0])
    np.testing.assert_allclose(drawn[3], np.degrees(path.angles[:, 0]))
    np.testing.assert_allclose(axes[11].lines[0].get_ydata(), np.degrees(path.rates[:, 5]))


def test_contacts_change_where_hip_heights_cross(path):
    for axes in hip_heights(path, title="A walk").axes:
        pair, down, middle, other = (line.get_ydata() for line in axes.lines)
        changed = np.flatnonzero(np.diff(np.isnan(down)))
        assert len(changed) >= 1
        # The outer side changes when the inner one does, some steps off.
        assert np.all(np.abs(pair[changed] - middle[changed]) < 2.0)
        assert np.all(np.isnan(down) != np.isnan(other))


def test_coordinates_of_kinematics_have_no_accelerations(path):
    kinematic = replace(path, acceleration=np.full_like(path.acceleration, np.nan))
    assert len(coordinates(kinematic, title="A walk").axes) == 12
    assert len(coordinates(path, title="A walk").axes) == 18
