# SPDX-License-Identifier: MIT
"""A walk folder says how it was made, and holds the pictures that were asked for and its band."""

from dataclasses import replace

import numpy as np
import pytest

from model.gait import tripod_angles, tripod_reference
from model.poses import Poses
from support.drawn_figures import figures_saved
from support.walk_posteriors import OFF
from support.watchers import Nobody
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.provenance import file_hash
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.walk.folder import PICTURES, read_draws, read_walk_manifest
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.request import BandRequest, ModelRequest, PictureRequest
from zebro_lab.walk.walking import Walked

pytestmark = pytest.mark.usefixtures("blank_pictures")

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0, direction="left")


@pytest.fixture
def finished(walked, tmp_path) -> Walked:
    """Return a walk of a robot from a file, over a slip law without one."""
    (tmp_path / "robot.toml").write_text("mass = 2.0\n[legs]\noffset_deg = [0, 0, 5, 0, 0, 0]\n")
    robot = read_robot_file(tmp_path / "robot.toml")
    return Walked(walked, GAIT, robot, parse_slip("coulomb:0.4"), "dynamics", 0.01, "tripod", ())


def write(out, walk, watcher=None, **options):
    request = ModelRequest(slip="coulomb:0.4", **options)
    write_walk(out, request, walk, watcher or Nobody(), kind="predict", settings={"log": "a"})
    return read_walk_manifest(out)


def test_how_a_walk_was_made_is_in_its_manifest(finished, tmp_path):
    manifest = write(tmp_path / "out", finished)
    assert (manifest["kind"], manifest["source"]) == ("predict", "sim:dynamics")
    settings = manifest["settings"]
    expected = {"model": "dynamics", "dt": 0.01, "log": "a", "walks": None}
    assert {name: settings[name] for name in expected} == expected
    assert settings["slip"] == {"named": "coulomb:0.4", "source": finished.slip.source}
    assert settings["robot"]["mass"] == 2.0
    assert settings["robot"]["leg_offset"][2] == pytest.approx(OFF)
    assert "band" not in settings
    robot = tmp_path / "robot.toml"
    assert manifest["inputs"] == {str(robot): file_hash(robot)}
    assert {file.name for file in (tmp_path / "out").iterdir()} == {"path.csv", "manifest.json"}
    plain = replace(finished, slip=None, described=RobotFile(), model="no-slip")
    manifest = write(tmp_path / "out", plain)
    assert (manifest["settings"]["slip"], manifest["inputs"]) == (None, {})


def test_a_band_is_written_with_its_settings(finished, tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    shifts = np.linspace(-0.1, 0.1, 4)[:, None, None] * [0.0, 1.0]
    path = finished.path.poses
    band = Poses(path.t, path.position + shifts, np.tile(path.yaw, (4, 1)))
    manifest = write(tmp_path / "out", replace(finished, band=band), band=BandRequest(4, seed=7))
    assert manifest["settings"]["band"]["draws"] == 4
    assert manifest["settings"]["band"]["seed"] == 7
    np.testing.assert_allclose(read_draws(tmp_path / "out").states, band.states, atol=1e-6)
    assert list(saved) == ["band.png"]


def test_pictures_and_film_come_only_when_asked_for(finished, tmp_path, monkeypatch):
    saved = figures_saved(monkeypatch)
    filmed = []

    def animate(path, robot, folder, *, title, progress, ground):
        filmed.append(title)
        progress(0.5)

    monkeypatch.setattr("zebro_lab.plots.animation.animate", animate)
    write(tmp_path / "bare", finished)
    assert not saved
    assert not filmed
    watcher = Nobody()
    write(tmp_path / "all", finished, watcher, pictures=PictureRequest(figures=True, animate=True))
    assert set(saved) == {f"{name}.png" for name in (*PICTURES, "stances")}
    assert filmed == ["tripod"]
    assert watcher.seen == [("drawing", None), ("filming", 0.5)]
