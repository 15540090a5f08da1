# SPDX-License-Identifier: MIT
"""One call takes photographs to a track, in whichever way the robot is known."""

from dataclasses import replace

import numpy as np
import pytest

from tracking import track_photos
from tracking.errors import CompositeError, NoUsablePhoto
from tracking.images import PhotoTimes


def every_two_seconds(names):
    return PhotoTimes(2.0 * np.arange(len(names)), np.zeros(len(names)), "an interval")


def test_a_marked_walk_is_tracked(scene, photos, walk):
    tracked = track_photos(scene, photos, times_of=every_two_seconds)
    assert tracked.lost == {}
    np.testing.assert_allclose(tracked.track.t, [0, 2, 4])
    np.testing.assert_allclose(tracked.track.poses, walk, atol=2e-3)
    assert {seen.source for seen in tracked.track.observations} == {"marker"}


def test_one_picture_that_is_merged_is_no_photograph(scene, photos):
    with pytest.raises(CompositeError, match="body has no size"):
        track_photos(replace(scene, is_composite=True), photos, times_of=every_two_seconds)


@pytest.mark.parametrize("is_composite", [False, True])
def test_no_photographs_at_all_are_refused(is_composite, scene):
    with pytest.raises(NoUsablePhoto, match="no photographs"):
        track_photos(replace(scene, is_composite=is_composite), (), times_of=every_two_seconds)
