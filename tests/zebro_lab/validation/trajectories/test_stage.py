# SPDX-License-Identifier: MIT
"""`validate REFERENCE ESTIMATE` writes a folder, prints a table, and refuses what does not fit."""

import json

import numpy as np
import pandas as pd
import pytest

from support.foreign_trajectories import drive, kitti, tum, written
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.validation.trajectories.stage import trajectory_columns

pytestmark = pytest.mark.usefixtures("blank_pictures")

T, POSITION, ROTATION = drive()


@pytest.fixture
def files(tmp_path):
    truth = written(tmp_path / "truth.txt", tum(T, POSITION, ROTATION))
    return truth, written(
        tmp_path / "slam.txt", tum(T, POSITION + np.array([0.3, 0.4, 0.0]), ROTATION)
    )


def test_a_shift_is_the_error_everywhere_and_gone_after_alignment(run_command, files, tmp_path):
    ended = run_command("validate", *files, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    assert "absolute error (ATE), rms" in ended.out
    assert "plane xy" in ended.out
    assert "60 of 60 reference and 60 estimated poses are matched" in ended.out
    table = pd.read_csv(tmp_path / "out/metrics.csv")
    assert table["in"].tolist() == ["plane xy", "space"]
    np.testing.assert_allclose(table["ate_m"], 0.5, atol=1e-7)
    np.testing.assert_allclose(table[["ate_aligned_m", "rpe_step_m", "rpe_2m_m"]], 0, atol=1e-7)
    errors = pd.read_csv(tmp_path / "out/errors.csv")
    np.testing.assert_allclose(np.hypot(errors.along_m, errors.cross_m), 0.5, atol=1e-7)
    np.testing.assert_allclose(errors.distance_in_space_m, 0.5, atol=1e-7)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    assert manifest["kind"] == "trajectories"
    assert set(manifest["outputs"]) == {
        "metrics.csv", "errors.csv", "trajectories.png", "reference.tum", "estimate.tum",
    }  # fmt: skip
    assert set(manifest["inputs"]) == {str(file) for file in files}


@pytest.mark.parametrize(
    ("factor", "units"),
    [(1000, "mm and m"), (0.001, "mm and m"), (100, "cm and m"), (25.4, "mm and inches")],
)
def test_lengths_in_another_unit_are_asked_about(run_command, files, tmp_path, factor, units):
    other = written(tmp_path / "b.tum", tum(T, factor * POSITION, ROTATION))
    ended = run_command("validate", files[0], other, "--out", tmp_path / "out")
    assert ended.code == 0
    assert (
        f"times as far as {files[0] if factor > 1 else other}, about as {units} differ: is"
        in " ".join(ended.out.split())
    )
    assert ended.out.startswith("WARNING: ")
    ended = run_command("validate", files[0], other, "--correct-scale", "--out", tmp_path / "out")
    assert "WARNING" not in ended.out
    twice = written(tmp_path / "c.tum", tum(T, 2 * POSITION, ROTATION))
    ended = run_command("validate", files[0], twice, "--out", tmp_path / "out")
    assert "WARNING" not in ended.out


def test_files_of_one_name_are_told_apart_by_their_folders(run_command, files, tmp_path):
    other = tmp_path / "other" / files[0].name
    other.parent.mkdir()
    files[1].rename(other)
    ended = run_command("validate", files[0], other, "--out", tmp_path / "out")
    assert f"other/truth.txt against {tmp_path.name}/truth.txt" in ended.out
    ended = run_command("validate", files[0], files[0], "--out", tmp_path / "out")
    assert "truth.txt against itself" in ended.out


def test_a_flat_table_is_validated_in_the_plane_alone(run_command, files, tmp_path):
    frame = pd.DataFrame(
        np.column_stack([T, 1000 * POSITION[:, :2]]), columns=["when", "east", "north"]
    )
    frame.to_csv(tmp_path / "track.csv", index=False)
    (tmp_path / "c.toml").write_text(
        '[columns]\nt_s = "when"\nx_m = {name = "east", unit = "mm"}\n'
        'y_m = {name = "north", unit = "mm"}\n'
    )
    arguments = [files[0], tmp_path / "track.csv", "--columns", tmp_path / "c.toml"]
    ended = run_command("validate", *arguments, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    table = pd.read_csv(tmp_path / "out/metrics.csv")
    assert table["in"].tolist() == ["plane xy"]
    assert table["ate_m"][0] < 1e-9
    assert table[["rpe_step_m", "rotation_rms_deg"]].isna().all(axis=None)


def test_another_clock_is_set_by_the_offset(run_command, files, tmp_path):
    late = written(tmp_path / "late.txt", tum(T + 100, POSITION, ROTATION))
    ended = run_command("validate", files[0], late, "--out", tmp_path / "out")
    assert ended.code == 1
    assert "late.txt: poses with a reference pose within 0.01 s: 0; expected 3 or more" in ended.err
    assert not (tmp_path / "out").exists()
    ended = run_command("validate", files[0], late, "--time-offset", 100, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err


def test_poses_without_times_are_matched_by_number_or_not_at_all(run_command, files, tmp_path):
    whole = written(tmp_path / "a.txt", kitti(POSITION, ROTATION))
    part = written(tmp_path / "b.txt", kitti(POSITION[1:], ROTATION[1:]))
    ended = run_command("validate", whole, part)
    assert ended.code == 1
    assert "b.txt: has 59 poses without times, the reference has 60" in ended.err
    ended = run_command("validate", whole, files[0], "--plane", "xy")
    assert ended.code == 1
    assert "a.txt: has no times, and the other file has; give" in ended.err
    np.savetxt(tmp_path / "times.txt", T)
    arguments = [whole, files[0], "--plane", "xy", "--times", tmp_path / "times.txt"]
    ended = run_command("validate", *arguments, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    assert pd.read_csv(tmp_path / "out/metrics.csv")["ate_m"].max() < 1e-9


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["third.txt"], "3 paths; give run folders, or two files of trajectories"),
        (["--predicted", "p", "--track", "t"], "belongs to predicted walks"),
        (["--no-anchor"], "belongs to predicted walks"),
        (["--plane", "xx"], "xx"),
        (["--layout", "rosbag"], "rosbag"),
        (["--topic", "/odom"], "--topic: belongs to ROS logs; no file is one"),
        (["--max-difference", "-1"], "--max-difference"),
    ],
)
def test_wrong_usage_ends_with_2(run_command, files, more, message):
    ended = run_command("validate", *files, *more)
    assert ended.code == 2
    assert message in " ".join(ended.err.replace("│", " ").split())


def test_options_of_trajectories_do_not_go_with_runs(run_command, tmp_path):
    ended = run_command("validate", tmp_path, "--correct-scale")
    assert ended.code == 2
    assert "belongs to two trajectories" in ended.err


def test_a_file_beside_a_folder_is_wrong_usage(run_command, files, tmp_path):
    ended = run_command("validate", files[0], tmp_path)
    assert ended.code == 2
    assert "is a folder" in " ".join(ended.err.replace("│", " ").split())


def test_a_missing_estimate_is_named(run_command, files, tmp_path):
    ended = run_command("validate", files[0], tmp_path / "none.txt")
    assert ended.code == 1
    assert "none.txt: no such file" in ended.err


@pytest.fixture
def log(tmp_path):
    """Return a bag with a path on two topics, the second 0.5 m off."""
    bags = pytest.importorskip("support.written_bags", reason="rosbags is an extra")
    path = np.column_stack([0.1 * T, 0.05 * T**2, 0.1 * T])
    shifted = path + np.array([0.3, 0.4, 0.0])
    parts = bags.stamped(T, path, topic="/truth"), bags.odometry(T, shifted)
    return bags.write_bag(tmp_path / "log", *parts)


def test_two_topics_of_a_ros_log_are_validated(run_command, log, tmp_path):
    topics = ["--topic", "/truth", "--topic", "/odom"]
    ended = run_command("validate", log, log, *topics, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    table = pd.read_csv(tmp_path / "out/metrics.csv")
    assert table["in"].tolist() == ["plane xy", "space"]
    np.testing.assert_allclose(table["ate_m"], 0.5, atol=1e-7)
    np.testing.assert_allclose(table[["ate_aligned_m", "rotation_rms_deg"]], 0, atol=1e-6)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    assert manifest["layouts"] == ["ros", "ros"]
    assert any(name.endswith("metadata.yaml") for name in manifest["inputs"])


@pytest.mark.parametrize(
    ("more", "code", "message"),
    [
        ([], 1, "has poses on the topics /odom, /truth; choose one with --topic NAME"),
        (["--topic", "/trut"], 1, "has no poses on topic /trut; did you mean '/truth'?"),
        (["--topic", "/odom", "--times", "t.txt"], 2, "whose messages have times"),
        (["--topic", "/odom", "--layout", "tum"], 2, "is a ROS log; leave the option out"),
    ],
)
def test_what_a_ros_log_does_not_tell_is_asked_for(run_command, log, tmp_path, more, code, message):
    ended = run_command("validate", log, log, *more, "--out", tmp_path / "out")
    assert ended.code == code
    assert message in ended.err
    assert not (tmp_path / "out").exists()


def test_a_column_map_beside_or_above_states_the_source_and_is_named(run_command, files, tmp_path):
    (tmp_path / "columns.toml").write_text('source = "sim:x"\n[legs]\n')
    ended = run_command("validate", *files, "--out", tmp_path / "out")
    assert ended.out.startswith("SIMULATED: sim:x")
    below = tmp_path / "below"
    below.mkdir()
    moved = [file.rename(below / file.name) for file in files]
    ended = run_command("validate", *moved, "--out", tmp_path / "out")
    said = " ".join(ended.out.split())
    assert ended.out.startswith("SIMULATED: sim:x")
    assert "truth.txt: its source, sim:x, is stated in" in said


MAP = '[columns]\nx_m = {name = "east", unit = "mm"}\n'
SECTION = MAP.replace("[columns]", "[track.columns]")


@pytest.fixture
def beside(tmp_path):
    """Return a function that writes a columns.toml, and reads that of a trajectory beside it."""

    def read(text, named=None):
        (tmp_path / "columns.toml").write_text(text)
        return trajectory_columns(tmp_path / "a.csv", named)

    return read


def test_a_section_beside_the_file_or_a_whole_named_file_is_read(beside, tmp_path):
    assert trajectory_columns(tmp_path / "a.csv", None) is None
    assert beside(MAP) is None  # of a rig or of legs
    for text, named in ((SECTION, None), (MAP, tmp_path / "columns.toml")):
        found = beside(f'source = "real"\n{text}', named)
        assert (found.mapped["x_m"].name, found.mapped["x_m"].factor) == ("east", 1e-3)
        assert found.source == "real"
    with pytest.raises(NotFound):
        trajectory_columns(tmp_path / "a.csv", tmp_path / "other.toml")


@pytest.mark.parametrize("rest", ["[legs]\n", MAP])
def test_the_source_of_a_file_that_maps_other_tables_is_kept(beside, rest):
    found = beside(f'source = "sim:x"\n{rest}')
    assert (found.source, found.mapped["x_m"].name) == ("sim:x", "x_m")


def test_guesses_that_nobody_has_checked_are_named(beside, tmp_path):
    guessed = 'x_m = {name = "east?", unit = "mm?"}\n'
    message = r"2 values are guesses .*x_m\.name = \"east\?\", .*x_m\.unit = \"mm\?\""
    with pytest.raises(SettingsError, match=message):
        beside(f"[track.columns]\n{guessed}")
    with pytest.raises(SettingsError, match=message):
        beside(f"[columns]\n{guessed}", tmp_path / "columns.toml")
    assert beside(f"{SECTION}[legs.columns]\nt = 'time?'\n") is not None


def test_a_section_that_is_no_table_is_refused(beside):
    with pytest.raises(SettingsError, match="expected a section"):
        beside("track = 3\n")
