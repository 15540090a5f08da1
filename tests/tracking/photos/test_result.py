# SPDX-License-Identifier: MIT
"""Corrections are replayed, and what a person should know is said."""

import re
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from tracking.corrections import Delete, Move
from tracking.floor import FloorFit
from tracking.images import PhotoTimes
from tracking.path import PoseObservation
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.result import finish, times_by_name
from tracking.pose import BodyPose
from tracking.shared import SharedErrors


@pytest.fixture
def seen(scene) -> FloorSeen:
    # Nothing else of it is read.
    fit = SimpleNamespace(warnings=("the tape slipped",), shared=SharedErrors.none(), suspicion=())
    return FloorSeen(cast("FloorFit", fit), (), {"p9.png": "cut short"})


def walked(scene, count=6, higher=0.0):
    z = scene.prior.height + higher
    return [
        PoseObservation(
            f"p{k}.png", 2.0 * k, 0.0,
            BodyPose(np.array([0.1 * k, 0.0, z, 0.0, 0.0, 0.0]), 1e-8 * np.eye(6)), 0.9, "marker",
        )
        for k in range(count)
    ]  # fmt: skip


def finished(scene, seen, observations, **other):
    times = {each.photo: (each.t, 0.0) for each in walked(scene, 8)}
    return finish(scene, seen, observations, unseen={"p7.png": "unseen"}, times=times, gap=None,
                  **other)  # fmt: skip


def test_what_is_deleted_and_what_is_placed_by_hand_is_told(scene, seen):
    asked = replace(scene, corrections=(Delete("p1.png"), Move("p7.png", 0.7, 0.0, 0.0)))
    found = finished(asked, seen, walked(scene))
    assert found.lost == {"p9.png": "cut short", "p1.png": "deleted by a correction"}
    assert found.notes[0] == "the tape slipped"
    assert any(note.startswith("2 corrections are applied; 1 of them") for note in found.notes)
    assert found.track.observations[-1].source == "hand"


def test_a_gap_is_told(scene, seen):
    observations = walked(scene)
    late = replace(observations[-1], t=60.0)
    notes = finished(scene, seen, [*observations[:-1], late]).notes
    assert any("no pose is found in the 52.0 s before p5.png" in note for note in notes)


@pytest.mark.parametrize(("higher", "told"), [(0.0, None), (0.03, "more"), (-0.03, "less")])
def test_a_body_that_seems_higher_or_lower_than_stated_is_told(scene, seen, higher, told):
    unsure = replace(scene, robot=None, prior=replace(scene.prior, mean_height_sd=5e-3))
    notes = finished(unsure, seen, walked(scene, higher=higher)).notes
    of_height = [note for note in notes if "the height of the body" in note]
    assert len(of_height) == (told is not None)
    for note in of_height:  # drawn towards what was stated
        off, way = re.findall(r"([\d.]+) mm (more|less) than stated", note)[0]
        assert float(off) == pytest.approx(30.0, rel=0.15)
        assert way == told


def test_a_robot_that_moves_against_its_heading_is_asked_about(scene, seen):
    about = np.array([0, 0, 0, 0, 0, np.pi])
    turned = [
        replace(each, pose=replace(each.pose, state=each.pose.state + about))
        for each in walked(scene)
    ]
    notes = finished(scene, seen, turned).notes
    assert any("moves backwards" in note for note in notes)
    assert not any("moves" in note for note in finished(scene, seen, walked(scene)).notes)


def test_times_go_by_name():
    times = PhotoTimes(np.array([0.0, 2.0]), np.array([0.1, 0.2]), "a table")
    assert times_by_name(["a", "b"], times) == {"a": (0.0, 0.1), "b": (2.0, 0.2)}
