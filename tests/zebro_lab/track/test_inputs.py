# SPDX-License-Identifier: MIT
"""What is known is read before photographs are looked at, and what is missing is said."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from support.bundled_walk import COMPOSITE
from tracking.pose import BodyPrior
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.robot.robot_file import Marker, RobotFile
from zebro_lab.track.inputs import body_prior, read_inputs, tracked_robot
from zebro_lab.track.photo_sequence import open_photos
from zebro_lab.track.request import TimeRequest


def checked(asked):
    inputs = read_inputs(asked)
    with open_photos(asked.photos, asked.times) as sequence:
        inputs.require_complete()
        return inputs, sequence


def test_what_the_files_say_is_known_of_the_scene(request_):
    inputs, sequence = checked(request_)
    scene = inputs.scene_of(sequence)
    assert scene.floor.marker_ids == (10, 11, 12, 13)
    assert scene.robot is not None
    assert scene.robot.marker.marker_id == 0
    assert not scene.is_composite
    assert scene.body_size is not None
    assert inputs.source_of(sequence) == "sim:photographs"
    assert replace(inputs, request=replace(request_, source="real")).source_of(sequence) == "real"


def test_one_picture_is_a_composite_whose_exposures_are_not_counted_yet(request_):
    inputs, sequence = checked(replace(request_, photos=COMPOSITE, times=TimeRequest(4.0)))
    assert inputs.scene_of(sequence).is_composite
    assert inputs.counted_times(sequence).times is None


def test_without_a_marker_the_robots_top_must_be_marked(request_):
    with pytest.raises(SettingsError, match="annotate PHOTOS"):
        checked(replace(request_, without_marker=True))


PRIOR = BodyPrior(0.06)


def test_a_print_without_yaw_has_its_top_ahead():
    robot = tracked_robot(RobotFile(marker=Marker((0.01, 0, 0.04))), prior=PRIOR)
    top_left, top_right, _, bottom_left = robot.marker.points_body
    np.testing.assert_allclose(top_left, [0.07, 0.06, 0.04], atol=1e-12)
    np.testing.assert_allclose(top_right, [0.07, -0.06, 0.04], atol=1e-12)
    np.testing.assert_allclose(bottom_left, [-0.05, 0.06, 0.04], atol=1e-12)


def test_the_body_is_as_high_as_its_marker_less_its_place_on_it():
    described = RobotFile(marker=Marker((0, 0, 0.04), height=0.105))
    standing = body_prior(described, height=None, mean_height_sd=0.005, height_sd=0.005)
    assert standing.height == pytest.approx(0.065)
    prior = body_prior(described, height=0.07, mean_height_sd=0.001, height_sd=0.006)
    assert (prior.height, prior.height_sd, prior.mean_height_sd) == (0.07, 0.006, 0.001)


def test_a_number_beyond_its_dictionary_says_how_far_it_goes():
    own = RobotFile(
        marker=Marker((0, 0, 0.04), printed=MarkerPrint(number=99)), file=Path("robot.toml")
    )
    with pytest.raises(SettingsError, match=r"robot\.toml, marker: marker 99 .* 0 to 49"):
        tracked_robot(own, prior=PRIOR)


def test_what_is_missing_or_impossible_is_named():
    with pytest.raises(SettingsError, match="marker"):
        tracked_robot(RobotFile(), prior=PRIOR)
    with pytest.raises(SettingsError, match=r"marker\.height"):
        body_prior(
            RobotFile(marker=Marker((0, 0, 0.04))), height=None, mean_height_sd=0.1, height_sd=0.1
        )
    with pytest.raises(SettingsError, match="--height-sd"):
        body_prior(RobotFile(), height=0.06, mean_height_sd=0.1, height_sd=0.0)
    with pytest.raises(SettingsError, match="--mean-height-sd"):
        body_prior(RobotFile(), height=0.06, mean_height_sd=0.0, height_sd=0.1)
    tilted = RobotFile(marker=Marker((0, 0, 0.04), (0.3, 0, 0)))
    with pytest.raises(SettingsError, match="level"):
        tracked_robot(tilted, prior=PRIOR)
