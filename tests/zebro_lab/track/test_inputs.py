# SPDX-License-Identifier: MIT
"""What is known is read before photographs are looked at, and what is missing is said."""

from dataclasses import replace

import pytest

from support.bundled_walk import COMPOSITE
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.inputs import read_inputs
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
