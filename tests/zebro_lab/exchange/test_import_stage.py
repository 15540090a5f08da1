# SPDX-License-Identifier: MIT
"""Files that others recorded become run folders that every stage reads like recorded ones."""

from datetime import UTC, datetime

import numpy as np
import pandas as pd
import pytest

from support.foreign_trajectories import drive, tum, written
from support.imported_files import COLUMNS, THETA, YAW, T, everything, taken
from support.leg_motions import T as T12
from support.leg_motions import tripod
from support.watchers import Nobody
from support.written_bags import JOINTS, imu, joints, odometry, transforms, write_bag
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.mcap.log_writer import LOG, WARNING
from zebro_lab.mcap.ros_log import read_messages
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.track.file import read_track
from zebro_lab.track.trajectory.request import Plane, TrajectoryRequest
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.walk.request import ModelRequest, PredictRequest
from zebro_lab.walk.stage import predict


def test_leg_angles_come_back_in_si_whatever_their_names_and_units(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    log = read_leg_log(folder)
    np.testing.assert_allclose(log.reference.t, T, atol=1e-12)
    turns = (log.reference.theta - THETA) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns[:1]) + 0 * turns, atol=1e-12)
    assert log.source == "sim:other-lab"


@pytest.mark.parametrize("track", ["track.csv", "path.tum"])
def test_a_track_is_what_validate_takes(files, tmp_path, track):
    folder, _ = everything(files, tmp_path, track)
    (folder / "prediction").mkdir()
    (folder / "prediction" / "path.csv").touch()
    _, place = pairs_of_run(folder)
    tracked = read_track(place)
    np.testing.assert_allclose(tracked.poses.t, T[::20])
    np.testing.assert_allclose(tracked.poses.position[:, 0], np.sin(YAW), atol=1e-9)
    np.testing.assert_allclose(tracked.poses.yaw, YAW, atol=1e-9)
    expected = np.diag([1e-6, 4e-6, 1e-4]) if track == "track.csv" else np.zeros((3, 3))
    np.testing.assert_allclose(tracked.covariance[3], expected)
    exact = any("taken as exact" in note for note in tracked.notes)
    assert exact == (track == "path.tum")


def test_standard_deviations_that_are_stated_are_those_of_the_track(files, tmp_path):
    stated = {"track_sd": "2 mm", "track_sd_yaw": "0.2 deg"}
    imported = taken(tmp_path, legs=files / "legs.csv", track=files / "path.tum", **stated)
    tracked = read_track(imported.folder / "track")
    expected = np.diag([2e-3, 2e-3, np.radians(0.2)]) ** 2
    np.testing.assert_allclose(tracked.covariance, np.tile(expected, (len(tracked.poses), 1, 1)))
    assert not any("exact" in note or "--track-sd" in note for note in imported.notes)


def test_suspected_leg_angles_are_warned_of_and_kept_with_the_run(tmp_path):
    theta = tripod().angles(T12) * [1, -1, 1, -1, 1, -1]
    table = {"t": T12} | {f"theta{leg}": theta[:, leg - 1] for leg in range(1, 7)}
    pd.DataFrame(table).to_csv(tmp_path / "legs.csv", index=False)
    imported = taken(tmp_path, legs=tmp_path / "legs.csv")
    (line,) = [note for note in imported.notes if "legs 2, 4 and 6 turn backwards" in note]
    events, _ = read_messages(imported.folder / "log.mcap", (LOG,))
    assert [(each.content.level, each.content.msg) for each in events][1:] == [(WARNING, line)]
    (tmp_path / "robot.toml").write_text("[legs]\nsign = [1, -1, 1, -1, 1, -1]")
    right = taken(tmp_path, legs=tmp_path / "legs.csv", robot=tmp_path / "robot.toml", label="x")
    assert not any("WARNING" in note for note in right.notes)


def test_a_run_is_walked_by_the_robot_it_keeps(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    model = ModelRequest(model="no-slip-simple")
    walked = predict(PredictRequest(folder, tmp_path / "out", model=model), Nobody())
    assert walked.described.robot.mass == 3.0
    other = ModelRequest(model="no-slip-simple", robot=files / "r.toml")
    (files / "r.toml").write_text("mass = 2.0")
    walked = predict(PredictRequest(folder, tmp_path / "other", model=other), Nobody())
    assert walked.described.robot.mass == 2.0


def test_times_since_1970_tell_when_a_run_began(files, tmp_path):
    table = pd.read_csv(files / "legs.csv")
    table["time_ms"] += 1_772_600_767_000.0
    table.to_csv(files / "legs.csv", index=False)
    folder = taken(tmp_path, legs=files / "legs.csv").folder
    assert read_manifest(folder).start == "2026-03-04T05:06:07+00:00"
    assert read_leg_log(folder).reference.t[0] == pytest.approx(0.0, abs=1e-6)
    with pytest.raises(SettingsError, match=r"^--start: .* since 1970 .* 2026-03-04.*leave out"):
        taken(tmp_path, legs=files / "legs.csv", start=datetime(2026, 3, 4, tzinfo=UTC))
    with pytest.raises(SettingsError, match=r"add --track-offset 1772582400\.500$"):
        taken(
            tmp_path, legs=files / "legs.csv",
            start=datetime(2026, 3, 4, microsecond=500_000, tzinfo=UTC),
        )  # fmt: skip


@pytest.mark.parametrize("name", ["imu.csv", "track.csv"])
def test_files_that_share_no_time_are_not_imported(name, files, tmp_path):
    table = pd.read_csv(files / name)
    table[table.columns[0]] += 1e9
    table.to_csv(files / name, index=False)
    with pytest.raises(DataError, match=r"go from 100000000\d.* s, those of the legs from 0 to"):
        everything(files, tmp_path)
    assert not (tmp_path / "data").exists()


def test_an_imu_of_another_clock_is_brought_to_that_of_the_legs(files, tmp_path):
    table = pd.read_csv(files / "imu.csv")
    table.assign(t=table.t + 1000.0).to_csv(files / "imu.csv", index=False)
    with pytest.raises(DataError, match=r"state offset = -1000 in \[imu\.columns\.t\]"):
        everything(files, tmp_path)
    map_file = files / "columns.toml"
    map_file.write_text(map_file.read_text() + "\n[imu.columns.t]\noffset = -1000\n")
    everything(files, tmp_path)


def change(name, **changes):
    """Return what changes cells of a file: column=(row, value)."""

    def spoil(files):
        table = pd.read_csv(files / name).astype(object)
        for column, (row, value) in changes.items():
            table.loc[row, column] = value
        table.to_csv(files / name, index=False)

    return spoil


def rewritten(name, text):
    return lambda files: (files / name).write_text(text)


@pytest.mark.parametrize(
    ("spoil", "error", "message"),
    [
        (change("legs.csv", fl=(3, "")), DataError, "column 'fl', row 4.*empty"),
        (change("imu.csv", roll=(2, "x")), DataError, "imu.csv, column 'roll', row 3"),
        (rewritten("imu.csv", "t,a\n0,1\n1,2\n"), DataError, "of the orientation.* is missing"),
        (change("track.csv", east_mm=(1, "inf")), DataError, "track.csv, column 'east_mm', row 2"),
        (change("track.csv", cov_xx=(1, -1.0)), DataError, "negative eigenvalue"),
        (rewritten("columns.toml", COLUMNS + "\n[imu.columns.roll]\nunit = 'm'"), SettingsError,
         "imu.columns.roll.unit"),
        (lambda files: (files / "track.csv").unlink(), NotFound, "track.csv: no such file"),
    ],
)  # fmt: skip
def test_what_cannot_be_taken_is_named_and_leaves_nothing(files, tmp_path, spoil, error, message):
    spoil(files)
    with pytest.raises(error, match=message) as raised:
        everything(files, tmp_path)
    assert "\n" not in str(raised.value)
    assert not (tmp_path / "data").exists()


def test_stages_that_need_leg_angles_say_that_a_track_alone_has_none(tmp_path):
    file = written(tmp_path / "a.tum", tum(*drive()))
    folder = taken(tmp_path, track=file).folder
    with pytest.raises(DataError, match=r"^\S+: holds a track without leg angles; import"):
        read_leg_log(folder)
    with pytest.raises(DataError, match=r"without leg angles.*validate REFERENCE .*track\.csv$"):
        pairs_of_run(folder)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({}, "no file to import"),
        ({"imu": "imu.csv"}, "^--imu: belongs to a walk"),
        ({"track": "track.csv", "imu": "imu.csv"}, "^--imu: belongs to a walk"),
        ({"legs": "legs.csv", "trajectory": TrajectoryRequest(plane=Plane.XY)}, "^--track: .*add"),
        ({"track": "track.csv", "track_offset": 2.0}, "^--track-offset: .*files of both"),
        ({"track": "track.csv", "track_sd": "1 mm"}, "^--track-sd: .*track.csv has a covariance"),
        ({"track": "path.tum", "track_sd": "1 mm"}, "^--track-sd-yaw: .*path.tum has headings"),
    ],
)
def test_half_a_request_is_refused(files, tmp_path, changes, message):
    named = {k: files / v if str(v).endswith((".csv", ".tum")) else v for k, v in changes.items()}
    with pytest.raises(SettingsError, match=message):
        taken(tmp_path, **named)


@pytest.mark.parametrize("first", [2.2e9, 5e11])
@pytest.mark.parametrize("name", ["legs", "track"])
def test_times_beyond_what_a_log_can_hold_are_refused(tmp_path, name, first):
    file = tmp_path / f"{name}.csv"
    theta = {f"theta{leg}": tripod().angles(T12)[:, leg - 1] for leg in range(1, 7)}
    track = {"x": T12, "y": 0 * T12}
    pd.DataFrame({"t": first + T12} | (theta if name == "legs" else track)).to_csv(file)
    with pytest.raises(DataError, match=rf"{name}.csv.*beyond 2038-01-19.*since 1970"):
        taken(tmp_path, **{name: file})
    assert not list(tmp_path.glob("data/*"))


WALKED = tripod(1.2).angles(T12)
SEEN = T12[::10]
PATH = np.column_stack([0.05 * SEEN, 0.01 * SEEN**2, 0.2 * SEEN])
ORDER = [4, 0, 2, 5, 1, 3]  # of the joints in the messages


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return write_bag(
        tmp_path_factory.mktemp("bags") / "walk",
        joints(T12, WALKED[:, ORDER], names=[JOINTS[leg] for leg in ORDER]),
        odometry(SEEN, PATH, covariance=1e-4 * np.eye(6)),
        transforms(SEEN, {"base_link": PATH}), imu(T12),
    )  # fmt: skip


def test_legs_imu_and_track_come_from_one_bag(bag, tmp_path):
    imported = taken(tmp_path, legs=bag, imu=bag, track=bag, topic=("/odom",))
    folder = imported.folder
    manifest = read_manifest(folder)
    assert manifest.source == "import:walk"
    assert manifest.start == "2023-11-14T22:13:20+00:00"
    assert set(manifest.streams) == {"/legs/raw", "/imu/raw"}
    assert {name.rpartition("/")[2] for name in manifest.inputs} == {"metadata.yaml", "walk.db3"}
    log = read_leg_log(folder).reference
    np.testing.assert_allclose(log.theta - log.theta[0], WALKED - WALKED[0], atol=1e-9)
    track = read_track(folder / "track")
    np.testing.assert_allclose(track.poses.position, PATH[:, :2], atol=1e-9)
    np.testing.assert_allclose(track.covariance[0], 1e-4 * np.eye(3))
    assert not any("WARNING" in note for note in imported.notes)
    assert any(
        "poses are taken from topic /odom, not from /tf:base_link" in n for n in imported.notes
    )


def test_a_choice_among_topics_is_asked_for_and_must_be_one(bag, tmp_path):
    with pytest.raises(DataError, match=r"poses on the topics /odom, /tf:base_link; choose one"):
        taken(tmp_path, legs=bag, track=bag)
    with pytest.raises(SettingsError, match=r"--topic: found /o, but nothing is read from it"):
        taken(tmp_path, legs=bag, topic=("/o",))
    assert not (tmp_path / "data").exists()


def test_degrees_in_a_bag_are_told_by_columns_toml_and_suspected_without(tmp_path):
    bag = write_bag(tmp_path / "degrees", joints(T12 / 4, np.degrees(WALKED / 8)))
    suspected = taken(tmp_path, legs=bag, label="a").notes
    assert any("are the angles in degrees?" in note for note in suspected)
    units = "".join(f'theta{leg} = {{unit = "deg"}}\n' for leg in range(1, 7))
    (tmp_path / "columns.toml").write_text(f"[legs.columns]\n{units}")
    folder = taken(tmp_path, legs=bag, label="b").folder
    log = read_leg_log(folder).reference
    np.testing.assert_allclose(log.theta - log.theta[0], (WALKED - WALKED[0]) / 8, atol=1e-9)
