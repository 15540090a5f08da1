# SPDX-License-Identifier: MIT
"""Exposures of one picture become a track in the order of the walk."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracking import Photo
from tracking.body import Alignment
from tracking.composite import Exposure
from tracking.composite.body_box import BodyBox
from tracking.images import PhotoTimes
from tracking.photos import exposures
from tracking.photos.exposures import track_exposures
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress
from tracking.pose import BodyPose

BODY = (0.24, 0.2)


def every_four_seconds(names):
    return PhotoTimes(4.0 * np.arange(len(names)), np.zeros(len(names)), "an interval")


def tracked(scene, photo):
    return track_exposures(
        scene, photo, times_of=every_four_seconds, gap=None, progress=NoProgress()
    )


def test_exposures_by_their_markers_are_found_and_named(scene, photos, walk, tmp_path):
    first, last = (cv2.imread(str(photos[k].path)) for k in (0, 2))
    photo = Photo("walk.png", tmp_path / "walk.png")
    view = see_floor(scene, photos[2:], robot=None, workers=1, progress=NoProgress()).fit.pose_of(
        photos[2].name
    )
    box = BodyBox(scene.camera, view, BODY, scene.robot.marker.position[2], scene.prior.height)
    x, y, yaw = walk[2]
    cut = box.hidden(np.array([x, y, scene.prior.height, 0, 0, yaw]), margin=0.1)
    cv2.imwrite(str(photo.path), np.where(cut[..., None], last, first))
    found = tracked(replace(scene, body_size=BODY), photo)
    assert [seen.photo for seen in found.track.observations] == ["walk.png#1", "walk.png#2"]
    np.testing.assert_allclose(found.track.t, [0, 4])
    np.testing.assert_allclose(found.track.poses[:, :2], walk[[0, 2], :2], atol=4e-3)


@pytest.mark.parametrize(("score", "told"), [(0.9, False), (0.0, True)])
def test_exposures_that_could_not_be_aligned_are_told_of(scene, photos, monkeypatch, score, told):
    poses = [BodyPose(np.array([x, 0.2, 0.06, 0, 0, 0]), 1e-6 * np.eye(6)) for x in (0.7, 0.5, 0.6)]
    found = tuple(Exposure(Alignment(pose, score, 0.0), 1.0) for pose in poses)
    monkeypatch.setattr(exposures, "find_exposures", lambda *_, **__: found)
    track = tracked(replace(scene, body_size=BODY), photos[0])
    assert any("only roughly" in note for note in track.notes) == told
    np.testing.assert_allclose([seen.planar[0] for seen in track.track.observations],
                               [0.5, 0.6, 0.7])  # fmt: skip
