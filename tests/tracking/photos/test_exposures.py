# SPDX-License-Identifier: MIT
"""Exposures of one picture become a track in the order of the walk."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracking import Photo
from tracking.body import Alignment, align, marker_template
from tracking.composite import Exposure, Merged
from tracking.errors import CompositeError
from tracking.images import PhotoTimes
from tracking.photos import exposures
from tracking.photos.exposures import track_exposures
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress
from tracking.pose import BodyPose
from tracking.shared import PLACE, SIDE, TURN


def every_four_seconds(names):
    return PhotoTimes(4.0 * np.arange(len(names)), np.zeros(len(names)), "an interval")


def tracked(scene, photo, merged=Merged.DARKEST):
    return track_exposures(
        scene, photo, merged, times_of=every_four_seconds, gap=None, progress=NoProgress()
    )


def test_exposures_through_which_others_shine_are_found_and_named(scene, photos, walk, tmp_path):
    pictures = [cv2.imread(str(photos[k].path)) for k in (0, 2)]
    photo = Photo("walk.png", tmp_path / "walk.png")
    cv2.imwrite(str(photo.path), np.min(pictures, axis=0))
    found = tracked(replace(scene, body_size=(0.24, 0.2)), photo)
    assert [seen.photo for seen in found.track.observations] == ["walk.png#1", "walk.png#2"]
    np.testing.assert_allclose(found.track.t, [0, 4])
    np.testing.assert_allclose(found.track.poses[:, :2], walk[[0, 2], :2], atol=4e-3)


@pytest.mark.parametrize(("score", "told"), [(0.9, False), (0.0, True)])
def test_exposures_that_could_not_be_aligned_are_told_of(scene, photos, monkeypatch, score, told):
    poses = [BodyPose(np.array([x, 0.2, 0.06, 0, 0, 0]), 1e-6 * np.eye(6)) for x in (0.7, 0.5, 0.6)]
    found = tuple(Exposure(Alignment(pose, score, 0.0), 1.0) for pose in poses)
    monkeypatch.setattr(exposures, "find_exposures", lambda *_, **__: found)
    track = tracked(replace(scene, body_size=(0.24, 0.2)), photos[0])
    assert any("only roughly" in note for note in track.notes) == told
    np.testing.assert_allclose([seen.planar[0] for seen in track.track.observations],
                               [0.5, 0.6, 0.7])  # fmt: skip


@pytest.mark.parametrize(
    ("merged", "step", "told"),
    [(Merged.MEAN, 0.12, True), (Merged.MEAN, 0.3, False), (Merged.DARKEST, 0.12, False)],
)
def test_a_mean_whose_exposures_overlap_is_noted_as_less_sure_than_it_says(
    scene, photos, top, monkeypatch, merged, step, told
):
    poses = [
        BodyPose(np.array([x, 0.2, 0.06, 0, 0, 0]), 1e-6 * np.eye(6)) for x in step * np.arange(3)
    ]
    found = tuple(Exposure(Alignment(pose, 0.9, 0.0), 1.0) for pose in poses)
    monkeypatch.setattr(exposures, "find_exposures_like", lambda *_, **__: found)
    unmarked = replace(scene, robot=None, tops=(top,), body_size=(0.24, 0.2))
    notes = tracked(unmarked, photos[0], merged).notes
    assert any("standard deviations" in note for note in notes) == told


def test_the_size_of_the_body_must_be_known(scene, photos):
    with pytest.raises(CompositeError, match="body has no size"):
        tracked(scene, photos[0])


@pytest.mark.parametrize("shines_through", [False, True])
def test_what_is_stated_of_the_marker_moves_an_exposure_as_its_derivative_says(
    scene, photos, walk, shines_through
):
    pixels = cv2.imread(str(photos[0].path))
    view = see_floor(scene, photos[:1], robot=None, workers=1, progress=NoProgress()).fit.pose_of(
        photos[0].name
    )

    def pose(**changed):
        template = marker_template(replace(scene.robot.marker, **changed))
        found = align(pixels, scene.camera, view, template=template, prior=scene.prior,
                      start=walk[0], shines_through=shines_through)  # fmt: skip
        assert found is not None
        return found.pose

    marker, base = scene.robot.marker, pose()
    x, y, z = marker.position
    moved = {
        (PLACE, 0): (2e-3, pose(position=(x + 2e-3, y, z))),
        (PLACE, 1): (2e-3, pose(position=(x, y + 2e-3, z))),
        (TURN, 0): (0.02, pose(yaw=marker.yaw + 0.02)),
        (SIDE, 0): (2e-4, pose(side=marker.side + 2e-4)),
    }
    for (cause, k), (step, other) in moved.items():
        expected = base.by_cause[cause][[0, 1, 5], k] * step
        np.testing.assert_array_less(
            np.abs(other.planar - base.planar - expected), [3e-4, 3e-4, 2e-3]
        )
    assert abs(base.by_cause[TURN][5, 0] + 1) < 0.05
    assert np.linalg.norm(base.by_cause[PLACE][:2, 0]) == pytest.approx(1, abs=0.05)
