# SPDX-License-Identifier: MIT
"""Files that others recorded become run folders that every stage reads like recorded ones."""

import json
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from rig.backends import leg_driver, leg_link
from rig.errors import ProfileError
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.zebro.profile import load_leg_profile
from support.watchers import Nobody
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.exchange.export_stage import export_run
from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.exchange.import_stage import import_run
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound, SettingsError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import profile_file, read_manifest
from zebro_lab.runs.stage import list_runs
from zebro_lab.track.file import read_track
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.walk.predict_stage import predict
from zebro_lab.walk.request import ModelRequest, PredictRequest

T = np.arange(0.0, 2.0, 0.02)
THETA = 4.0 * T[:, None] + np.arange(6)
YAW = 0.1 * T[::20]
COLUMNS = """
source = "sim:other-lab"

[legs.columns]
t = {name = "time_ms", unit = "ms"}
theta1 = {name = "fl", unit = "deg"}
theta2 = {name = "fr", unit = "deg", sign = -1}

[imu.columns]
rate_z = {name = "yaw_rate", unit = "deg/s"}

[track.columns]
x_m = {name = "east_mm", unit = "mm"}
y_m = {name = "north_mm", unit = "mm"}
"""


@pytest.fixture
def files(tmp_path) -> Path:
    """Return a folder of a lab's own files, in its own names and units."""
    folder = tmp_path / "lab"
    folder.mkdir()
    legs = {"time_ms": 1e3 * T, "fl": np.degrees(THETA[:, 0]), "fr": -np.degrees(THETA[:, 1])}
    legs |= {f"theta{leg}": THETA[:, leg - 1] for leg in range(3, 7)}
    pd.DataFrame(legs).to_csv(folder / "legs.csv", index=False)
    imu = {"t": T, "roll": 0.1 * np.sin(T), "pitch": 0.2 * np.cos(T), "yaw_rate": 5.0 + 0 * T}
    pd.DataFrame(imu).to_csv(folder / "imu.csv", index=False)
    track = {"t": T[::20], "east_mm": 1e3 * np.sin(YAW), "north_mm": 1e3 * (1 - np.cos(YAW)),
             "yaw": YAW, "cov_xx": 1e-6, "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yy": 4e-6,
             "cov_yyaw": 0.0, "cov_yawyaw": 1e-4}  # fmt: skip
    pd.DataFrame(track).to_csv(folder / "track.csv", index=False)
    rows = [f"{t} {np.sin(y)} {1 - np.cos(y)} 0.06 0 0 {np.sin(y / 2)} {np.cos(y / 2)}"
            for t, y in zip(T[::20], YAW, strict=True)]  # fmt: skip
    (folder / "path.tum").write_text("# t x y z qx qy qz qw\n" + "\n".join(rows))
    (folder / "robot.toml").write_text("mass = 3.0\n[legs]\noffset_deg = [9, 0, 0, 0, 0, 0]\n")
    (folder / "columns.toml").write_text(COLUMNS)
    return folder


def taken(tmp_path, **files):
    request = ImportRequest(data=tmp_path / "data", **files)
    return import_run(request, Nobody())


def everything(files, tmp_path, track="track.csv"):
    imported = taken(
        tmp_path, legs=files / "legs.csv", imu=files / "imu.csv", track=files / track,
        robot=files / "robot.toml", label="circle", start=datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC),
    )  # fmt: skip
    (folder,) = imported.folders
    return folder, imported.notes


def test_leg_angles_come_back_in_si_whatever_their_names_and_units(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    log = read_leg_log(folder)
    np.testing.assert_allclose(log.reference.t, T, atol=1e-12)
    turns = (log.reference.theta - THETA) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns[:1]) + 0 * turns, atol=1e-12)
    assert log.source == "sim:other-lab"


def test_a_run_says_what_it_was_made_from_and_is_listed(files, tmp_path):
    folder, notes = everything(files, tmp_path)
    manifest = read_manifest(folder)
    assert folder.name == "20260304T050607Z_walk_circle"
    assert (manifest.exit_status, manifest.source) == ("imported", "sim:other-lab")
    names = ["legs.csv", "imu.csv", "track.csv", "robot.toml", "columns.toml"]
    assert manifest.inputs == {str(files / n): file_hash(files / n) for n in names}
    (run,) = list_runs(tmp_path / "data")
    assert (run.state, run.duration) == ("imported", "2.0 s")
    assert run.samples == "100 /legs/raw, 100 /imu/raw"
    assert any("without yaw" in note for note in notes)


def test_orientation_is_decoded_as_of_any_imu(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    stream = read_raw_log(folder / "log.mcap").streams["/imu/raw"]
    profile = load_imu_profile(str(profile_file(folder, "imu")))
    seen = decode_orientation(profile, stream)
    np.testing.assert_allclose(seen.roll, 0.1 * np.sin(T), atol=1e-12)
    np.testing.assert_allclose(seen.pitch, 0.2 * np.cos(T), atol=1e-12)
    np.testing.assert_allclose(stream.counts[:, 6], np.radians(5.0))
    assert np.isnan(stream.counts[:, [4, 5, 7, 8, 9]]).all()


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


def test_a_run_is_walked_by_the_robot_it_keeps(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    model = ModelRequest(model="no-slip-simple")
    walked = predict(PredictRequest(folder, tmp_path / "out", model=model), Nobody())
    assert walked.described.robot.mass == 3.0
    other = ModelRequest(model="no-slip-simple", robot=files / "r.toml")
    (files / "r.toml").write_text("mass = 2.0")
    walked = predict(PredictRequest(folder, tmp_path / "other", model=other), Nobody())
    assert walked.described.robot.mass == 2.0


def test_an_imported_run_is_exported_like_a_recorded_one(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    written = export_run(folder, to="csv", out=tmp_path / "tables")
    assert {file.name for file in written} >= {"legs.csv", "legs_raw.csv", "imu_raw.csv"}
    again = pd.read_csv(tmp_path / "tables" / "legs.csv", comment="#")
    np.testing.assert_allclose(again["t"], T, atol=1e-9)


def test_a_ros_log_of_joint_states_is_a_leg_log(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    imported = taken(tmp_path, legs=folder / "log.mcap", label="again")
    again = read_manifest(imported.folders[0])
    assert again.start == "2026-03-04T05:06:07+00:00"  # its stamps are seconds since 1970
    assert again.source == "import:log.mcap"
    ours, theirs = (read_leg_log(f).reference for f in (folder, imported.folders[0]))
    np.testing.assert_allclose(theirs.t, ours.t - ours.t[0], atol=1e-6)
    np.testing.assert_allclose(theirs.theta, ours.theta, atol=1e-9)


def test_a_log_without_leg_angles_is_refused(files, tmp_path):
    (files / "noise.mcap").write_bytes(b"\x00" * 500)
    with pytest.raises(DataError, match="no MCAP"):
        taken(tmp_path, legs=files / "noise.mcap")
    folder, _ = everything(files, tmp_path)
    (files / "named.toml").write_text('[legs]\ntopic = "/joints"')
    with pytest.raises(DataError, match="/legs/joint_states"):
        taken(tmp_path, legs=folder / "log.mcap", columns=files / "named.toml")


def test_a_rigs_table_is_calibrated_as_the_table_itself(sweep, tmp_path):
    table = sweep / "sweep.csv"
    imported = taken(tmp_path, rig=table, material="POM", start=datetime(2026, 1, 1, tzinfo=UTC))
    assert len(imported.folders) == 24
    ours, theirs = read_rig_data([tmp_path / "data"]), read_rig_data([table])
    order = np.argsort([ours.samples.run_names.index(f.name) for f in imported.folders])
    assert np.array_equal(order, np.arange(24))  # folders are named by when each run began
    for column in ("slip", "normal_force", "traction_force", "run"):
        ours_column, theirs_column = getattr(ours.samples, column), getattr(theirs.samples, column)
        np.testing.assert_allclose(ours_column, theirs_column, rtol=1e-12)
    assert ours.source == theirs.source == "sim:rig-sweep"
    assert ours.load_cell == theirs.load_cell == {"zero_stability": 0.1}
    assert read_manifest(imported.folders[0]).material == "POM"


def test_times_since_1970_tell_when_a_run_began(files, tmp_path):
    table = pd.read_csv(files / "legs.csv")
    table["time_ms"] += 1_772_600_767_000.0
    table.to_csv(files / "legs.csv", index=False)
    folder = taken(tmp_path, legs=files / "legs.csv").folders[0]
    assert read_manifest(folder).start == "2026-03-04T05:06:07+00:00"
    assert read_leg_log(folder).reference.t[0] == pytest.approx(0.0, abs=1e-6)


def test_files_that_share_no_time_are_told_of(files, tmp_path):
    table = pd.read_csv(files / "imu.csv")
    table["t"] += 100
    table.to_csv(files / "imu.csv", index=False)
    _, notes = everything(files, tmp_path)
    assert any("one clock" in note for note in notes)


def test_nobody_stated_a_source_so_that_the_file_is_it(files, tmp_path):
    (files / "columns.toml").write_text(COLUMNS.replace('source = "sim:other-lab"', ""))
    folder, _ = everything(files, tmp_path)
    assert read_manifest(folder).source == "import:legs.csv+imu.csv"


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
        (change("legs.csv", time_ms=(3, 0.0)), DataError, "time_ms.*row 4.*increasing"),
        (change("imu.csv", roll=(2, "x")), DataError, "imu.csv, column 'roll', row 3"),
        (rewritten("imu.csv", "t,a\n0,1\n1,2\n"), DataError, "holds no orientation"),
        (rewritten("imu.csv", "t,qw,qx,qy,qz\n0,2,0,0,0\n"), DataError, "length 2; expected 1"),
        (change("track.csv", east_mm=(1, "inf")), DataError, "track.csv, column 'east_mm', row 2"),
        (change("track.csv", t=(1, 0.0)), DataError, "row 2 .line 3.*increasing"),
        (change("track.csv", cov_xx=(1, -1.0)), DataError, "negative eigenvalue"),
        (rewritten("robot.toml", "masss = 2"), SettingsError, "did you mean 'mass'"),
        (rewritten("columns.toml", "[leg.columns]\n[legs]"), SettingsError, "mean 'legs'"),
        (rewritten("columns.toml", "[legs.columns]\ntheta9 = 'x'"), SettingsError,
         "legs.columns.theta9"),
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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 2 3\n", "found 3 numbers"),
        ("0 0 0 0 0 0 0 x\n", "could not convert"),
        ("0 0 0 0 0 0 0 0\n", "length 0"),
        ("# nothing\n", "is empty"),
        ("0 0 0 0 0 0 0 1\n" * 3, "increasing"),
    ],
)
def test_a_trajectory_of_another_form_is_refused(files, tmp_path, text, message):
    (files / "path.tum").write_text(text)
    with pytest.raises(DataError, match=message):
        everything(files, tmp_path, "path.tum")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({}, "nothing to import"),
        ({"imu": "imu.csv"}, "belongs to a walk|nothing to import"),
        ({"legs": "legs.csv", "start": datetime(2026, 1, 1)}, "no time zone"),
    ],
)
def test_half_a_request_is_refused(files, tmp_path, changes, message):
    named = {k: files / v if isinstance(v, str) else v for k, v in changes.items()}
    with pytest.raises(SettingsError, match=message):
        taken(tmp_path, **named)


@pytest.mark.parametrize(
    "start", ["0001-01-01T00:00:00+14:00", "1969-12-31T23:59:59+00:00", "9999-12-31T23:59:59-14:00"]
)
def test_a_start_that_no_log_can_hold_is_refused(files, tmp_path, start):
    with pytest.raises(SettingsError, match=r"^--start: found .* expected .* 1970 .* 2261$"):
        taken(tmp_path, legs=files / "legs.csv", start=datetime.fromisoformat(start))


def test_a_rig_without_speeds_or_with_trials_is_left_to_the_calibration(sweep, tmp_path):
    table = pd.read_csv(sweep / "sweep.csv")
    given = table.drop(columns=["omega_leg"]).assign(slip_ratio=0.1)
    given.to_csv(tmp_path / "slip.csv", index=False)
    with pytest.raises(DataError, match="calibrate-slip reads this table"):
        taken(tmp_path, rig=tmp_path / "slip.csv")
    table.to_csv(tmp_path / "trials.csv", index=False)
    (tmp_path / "columns.toml").write_text("[runs]\neach_row = true")
    with pytest.raises(DataError, match="averages of trials"):
        taken(tmp_path, rig=tmp_path / "trials.csv")


def test_a_run_that_is_there_is_not_written_over(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    before = (folder / "run.json").read_bytes()
    with pytest.raises(AlreadyExists, match="another label"):
        everything(files, tmp_path)
    assert (folder / "run.json").read_bytes() == before


def test_the_profile_of_a_table_is_no_devices(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    profile = load_leg_profile(str(profile_file(folder, "legs")))
    for make in (lambda: leg_link(profile, "x"), lambda: leg_driver(profile, None)):
        with pytest.raises(ProfileError, match="not a device"):
            make()


def test_the_log_shows_angles_and_orientation_to_any_viewer(files, tmp_path):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    folder, _ = everything(files, tmp_path)
    with (folder / "log.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        shown = {c.topic: m for _, c, _, m in reader.iter_decoded_messages()}
    assert len(shown["/legs/joint_states"].position) == 6
    q = shown["/imu/data"].orientation
    roll = Rotation.from_quat([q.x, q.y, q.z, q.w]).as_euler("ZYX")[2]
    assert roll == pytest.approx(0.1 * np.sin(T[-1]))
    assert json.loads((folder / "track" / "manifest.json").read_text())["kind"] == "track"
