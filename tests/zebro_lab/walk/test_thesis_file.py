# SPDX-License-Identifier: MIT
"""Quantities of the thesis's model in `thesis.csv`."""

import json

import numpy as np
import pandas as pd

from model.frames import attitude, rotation_y
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.thesis.legs import SwitchedLegs
from model.thesis.walk import walk_thesis
from support.watchers import Nobody
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.walk.folder import read_walk
from zebro_lab.walk.request import ModelRequest, PredictRequest, WalkRequest
from zebro_lab.walk.stage import predict, walk
from zebro_lab.walk.thesis_file import COLUMNS, write_thesis

ROBOT = Robot()
GAIT = tripod_reference(tripod_angles(np.radians(45.0), 1.2), 1.0)


def test_what_is_written_is_what_the_model_computed(tmp_path):
    path = walk_thesis(ROBOT, SwitchedLegs.of(GAIT), duration=0.6)
    write_thesis(tmp_path / "thesis.csv", path, ROBOT)
    table = pd.read_csv(tmp_path / "thesis.csv")
    assert tuple(table.columns) == COLUMNS
    path = path.part(slice(None, None, 10))
    np.testing.assert_allclose(table.t, path.t, atol=1e-9)
    np.testing.assert_allclose(table.theta_y, path.angles[:, 2], atol=1e-7)
    np.testing.assert_allclose(table.z_acceleration, path.acceleration[:, 2], rtol=1e-6, atol=1e-7)
    for leg in (1, 4):
        down = path.contact[:, leg - 1]
        assert table[f"v_R{leg}"].isna().equals(pd.Series(~down))
        np.testing.assert_allclose(
            table[f"v_C{leg}"][down], path.contact_speed[down, leg - 1], atol=1e-7
        )
        np.testing.assert_allclose(table[f"f_g{leg}"], path.static_load[:, leg - 1], atol=1e-6)


def test_the_written_angles_link_hip_and_contact(tmp_path):
    """Eq. (3-12): the contact lies at r + r cos(phi), -r sin(phi) of the hip frame."""
    path = walk_thesis(ROBOT, SwitchedLegs.of(GAIT), duration=0.3).part(slice(100, 101))
    write_thesis(tmp_path / "thesis.csv", path, ROBOT)
    (row,) = pd.read_csv(tmp_path / "thesis.csv").to_dict("records")
    r = ROBOT.leg_radius
    for leg in (1, 4, 5):
        phi = row[f"phi{leg}"]
        assert phi > 0  # it rolls
        in_hip = np.array([r + r * np.cos(phi), 0.0, -r * np.sin(phi)])
        rotation = attitude(*path.orientation[0]) @ rotation_y(path.theta[0, leg - 1])
        hip = np.array([row[f"hip_{axis}{leg}"] for axis in "xyz"])
        contact = [row[f"contact_{axis}{leg}"] for axis in "xyz"]
        np.testing.assert_allclose(hip + rotation @ in_hip, contact, atol=1e-7)


def test_a_walk_by_the_thesis_s_model_has_them_in_its_folder(tmp_path):
    request = ModelRequest("thesis", "thesis")
    asked = WalkRequest(GaitRequest(steering=1.2), 0.5, tmp_path / "out", request, thesis="text")
    walked = walk(asked, Nobody())
    assert "model 'thesis' (by the thesis's text)" in walked.title
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert manifest["settings"]["contact_by"] == "text"
    assert "thesis.csv" in manifest["outputs"]
    table = pd.read_csv(tmp_path / "out" / "thesis.csv")
    path = pd.read_csv(tmp_path / "out" / "path.csv")
    np.testing.assert_allclose(path.t[::10], table.t)
    logged = PredictRequest(tmp_path / "out", tmp_path / "predicted", model=request)
    predict(logged, Nobody())
    assert (tmp_path / "predicted" / "thesis.csv").exists()
    ours = WalkRequest(GaitRequest(steering=1.2), 0.5, tmp_path / "out", ModelRequest("thesis"))
    walk(ours, Nobody())
    assert not (tmp_path / "out" / "thesis.csv").exists()


def test_the_tetrapod_s_kinematics_have_them_too(run_command, tmp_path):
    words = ("walk", "--gait", "tetrapod", "--model", "thesis", "--duration", 1)
    assert run_command(*words, "--out", tmp_path / "w").code == 0
    table = pd.read_csv(tmp_path / "w" / "thesis.csv")
    assert tuple(table.columns) == COLUMNS
    np.testing.assert_allclose(table.t, np.arange(101) * 0.01, atol=1e-9)
    assert table.x_acceleration.isna().all()
    path = read_walk(tmp_path / "w").part(slice(None, None, 10))
    np.testing.assert_array_equal(table.v_C3.notna(), path.contact[:, 2])
    stood = path.contact[:, 2] & (table.phi3 > 0.1) & (table.phi3.diff().abs() < 0.02)
    np.testing.assert_allclose(table.contact_z3[stood], 0.0, atol=1e-6)
