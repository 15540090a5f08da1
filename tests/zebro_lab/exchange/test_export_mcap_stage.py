# SPDX-License-Identifier: MIT
"""An exported run is read by mcap and mcap-ros2-support alone; none of our code looks at it."""

from collections import Counter

import numpy as np
import pandas as pd
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from scipy.spatial.transform import Rotation

from model.poses import Poses
from model.robot import Robot
from support.written_runs import make_run
from zebro_lab.exchange.export_mcap_stage import export_mcap
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound
from zebro_lab.walk.folder import walk_folder, write_draws

YAW0, START = 0.7, np.array([1.0, -0.5])


@pytest.fixture(scope="module")
def run(walked, tmp_path_factory):
    """Return a folder with a made-up walk predicted from the origin and tracked from elsewhere."""
    folder = tmp_path_factory.mktemp("run")
    robot = Robot()
    described = {
        "hips": robot.hips.tolist(), "leg_radius": 0.035, "leg_arc": np.pi, "mass": 2.17,
        "body_size": list(robot.body_size), "inertia": robot.principal_inertia.tolist(),
    }  # fmt: skip
    rng = np.random.default_rng(2)
    t = np.arange(0.0, 4.01, 0.1)
    base = np.column_stack([np.interp(t, walked.t, column) for column in walked.position[:, :2].T])
    spread = rng.normal(0, 0.05, (80, 1, 1)) * t[:, None] / 4
    paths = Poses(t, base + spread, np.interp(t, walked.t, walked.yaw) + np.zeros((80, 1)))
    with walk_folder(
        folder / "prediction", walked, kind="predict", source="sim:dynamics",
        settings={"robot": described}, inputs={},
    ) as draft:  # fmt: skip
        write_draws(draft, paths)
    at = np.array([0.5, 1.5, 2.5, 3.5])
    seen = np.column_stack([np.interp(at, walked.t, a) for a in walked.position[:, :2].T])
    c, s = np.cos(YAW0), np.sin(YAW0)
    x, y = (seen @ np.array([[c, s], [-s, c]]) + START).T
    track = pd.DataFrame({
        "t_s": at, "x_m": x, "y_m": y, "yaw_rad": np.interp(at, walked.t, walked.yaw) + YAW0,
        "cov_xx": 4e-6, "cov_xy": 1e-6, "cov_xyaw": 0.0, "cov_yy": 9e-6, "cov_yyaw": 0.0,
        "cov_yawyaw": 1e-5,
    })  # fmt: skip
    (folder / "track").mkdir()
    track.to_csv(folder / "track/track.csv", index=False)
    return folder


@pytest.fixture(scope="module")
def messages(run, tmp_path_factory):
    """Return every message as a stranger decodes it: topic, time [s], message."""
    file = tmp_path_factory.mktemp("out") / "walk.mcap"
    exported = export_mcap(run, out=file)
    with file.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = [
            (channel.topic, message.log_time / 1e9, decoded)
            for _, channel, message, decoded in reader.iter_decoded_messages()
        ]
        metadata = [record.metadata for record in reader.iter_metadata()]
    assert Counter(topic for topic, _, _ in found) == exported.topics
    return found, metadata


def of(messages, topic):
    return [(t, decoded) for name, t, decoded in messages[0] if name == topic]


def test_legs_frames_track_and_band_are_there(messages):
    topics = {topic for topic, _, _ in messages[0]}
    assert {"/legs/joint_states", "/tf", "/track/path", "/track/pose"} < topics
    assert {"/prediction/path", "/prediction/pose", "/prediction/draws/20"} < topics


def test_the_file_says_what_is_simulated(messages):
    (source,) = messages[1]
    assert source["prediction"] == "sim:dynamics"


def test_a_prediction_lies_in_the_track_s_frame(messages):
    """The walk is the track's own, so that body and tracked robot coincide."""
    body, tracked = {}, {}
    for t, message in of(messages, "/tf"):
        for each in message.transforms:
            place = each.transform.translation
            kept = {"body": body, "tracked": tracked}.get(each.child_frame_id)
            if kept is not None:
                assert each.header.frame_id == "floor"
                kept[round(t, 3)] = (place.x, place.y)
    assert len(tracked) == 4
    for t, place in tracked.items():
        assert body[t] == pytest.approx(place, abs=2e-4)


def test_legs_turn_about_their_hips(messages, walked):
    t, message = next((t, m) for t, m in of(messages, "/tf") if t > 1 and len(m.transforms) > 1)
    row = int(np.abs(walked.t - t).argmin())
    legs = {each.child_frame_id: each.transform for each in message.transforms}
    for leg, hip in enumerate(Robot().hips, 1):
        here = legs[f"leg_{leg}"]
        assert (here.translation.x, here.translation.y, here.translation.z) == pytest.approx(hip)
        q = here.rotation
        centre = Rotation.from_quat([q.x, q.y, q.z, q.w]).apply([1.0, 0.0, 0.0])
        theta = walked.theta[row, leg - 1]  # 0 straight ahead, a quarter turn straight below
        assert centre == pytest.approx([np.cos(theta), 0.0, -np.sin(theta)], abs=1e-9)


def test_leg_angles_are_the_walk_s(messages, walked):
    states = of(messages, "/legs/joint_states")
    assert list(states[0][1].name) == [f"leg_{leg}" for leg in range(1, 7)]
    assert states[-1][0] == pytest.approx(walked.t[-1])
    np.testing.assert_allclose(states[-1][1].position, walked.theta[-1])


def test_tracked_poses_carry_their_covariance(messages):
    _, first = of(messages, "/track/pose")[0]
    covariance = np.array(first.pose.covariance).reshape(6, 6)
    np.testing.assert_allclose(covariance[:2, :2], [[4e-6, 1e-6], [1e-6, 9e-6]])
    assert covariance[5, 5] == pytest.approx(1e-5)
    assert np.all(covariance[2:5] == 0)


def test_the_band_grows_as_its_draws_do(messages):
    poses = [np.array(m.pose.covariance).reshape(6, 6) for _, m in of(messages, "/prediction/pose")]
    assert np.trace(poses[-1][:2, :2]) > 20 * np.trace(poses[5][:2, :2])
    (_, drawn), *_ = of(messages, "/prediction/draws/3")
    assert len(drawn.poses) == 41
    assert drawn.poses[0].header.frame_id == "floor"


def test_clocks_apart_are_refused_and_nothing_is_written(run, tmp_path):
    late = tmp_path / "late"
    (late / "track").mkdir(parents=True)
    (late / "prediction").symlink_to(run / "prediction")
    table = pd.read_csv(run / "track/track.csv").assign(t_s=lambda each: each["t_s"] + 100)
    table.to_csv(late / "track/track.csv", index=False)
    with pytest.raises(DataError, match="clock"):
        export_mcap(late, out=tmp_path / "late.mcap")
    assert not (tmp_path / "late.mcap").exists()


def test_what_is_missing_is_said(run, tmp_path):
    (tmp_path / "track").symlink_to(run / "track")
    exported = export_mcap(tmp_path, out=tmp_path / "t.mcap")
    assert set(exported.topics) == {"/tf", "/track/path", "/track/pose"}
    assert "predict" in exported.notes[0]
    with pytest.raises(AlreadyExists, match="--out"):
        export_mcap(tmp_path, out=tmp_path / "t.mcap")
    with pytest.raises(NotFound, match=r"run track --run .*, or predict .* before the export"):
        export_mcap(tmp_path / "nothing", out=tmp_path / "n.mcap")


def test_a_run_without_track_and_prediction_has_an_mcap_file_already(tmp_path):
    run = make_run(tmp_path)
    with pytest.raises(NotFound, match=r"log\.mcap is already an MCAP file of what was recorded"):
        export_mcap(run, out=tmp_path / "n.mcap")
    assert not (tmp_path / "n.mcap").exists()
