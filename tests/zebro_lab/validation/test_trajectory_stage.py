# SPDX-License-Identifier: MIT
"""`validate REFERENCE ESTIMATE` writes a folder, whose errors are those that evo finds."""

import copy
import json

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from support.foreign_trajectories import drive, euroc, kitti, tum, written
from support.watchers import Nobody
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.track.trajectory.request import Layout, Plane, TrajectoryRequest
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.trajectory_stage import validate_pair

pytestmark = pytest.mark.usefixtures("blank_pictures")

T, POSITION, ROTATION = drive()
UNIX = 1_400_000_000.0


@pytest.fixture
def files(tmp_path):
    shifted = tum(T, POSITION + np.array([0.3, 0.4, 0.0]), ROTATION)
    return (written(tmp_path / "truth.txt", tum(T, POSITION, ROTATION)),
            written(tmp_path / "slam.txt", shifted))  # fmt: skip


@pytest.fixture
def validated(tmp_path):
    """Return a function that validates two files, and returns the manifest and the errors."""

    def validate(*files, **options):
        request = ValidateRequest(files, out=tmp_path / "out", **options)
        judged = validate_pair(request, Nobody())
        return json.loads((tmp_path / "out/manifest.json").read_text()), judged

    return validate


def test_tables_poses_and_a_picture_are_written(validated, files, tmp_path):
    manifest, _ = validated(*files)
    assert manifest["kind"] == "trajectories"
    assert set(manifest["outputs"]) == {
        "metrics.csv", "errors.csv", "trajectories.png", "reference.tum", "estimate.tum",
    }  # fmt: skip
    assert set(manifest["inputs"]) == {str(file) for file in files}
    table = pd.read_csv(tmp_path / "out/metrics.csv")
    assert table["in"].tolist() == ["plane xy", "space"]
    np.testing.assert_allclose(table["ate_m"], 0.5, atol=1e-7)
    errors = pd.read_csv(tmp_path / "out/errors.csv")
    np.testing.assert_allclose(np.hypot(errors.along_m, errors.cross_m), 0.5, atol=1e-7)
    np.testing.assert_allclose(errors.distance_in_space_m, 0.5, atol=1e-7)


def test_a_flat_table_is_validated_in_the_plane_alone(validated, files, tmp_path):
    frame = pd.DataFrame(
        np.column_stack([T, 1000 * POSITION[:, :2]]), columns=["when", "east", "north"]
    )
    frame.to_csv(tmp_path / "track.csv", index=False)
    columns = tmp_path / "c.toml"
    columns.write_text(
        '[columns]\nt_s = "when"\nx_m = {name = "east", unit = "mm"}\n'
        'y_m = {name = "north", unit = "mm"}\n'
    )
    _, judged = validated(files[0], tmp_path / "track.csv", columns=columns)
    assert [row.where for row in judged.rows] == ["plane xy"]
    assert judged.rows[0].errors.ate.rms < 1e-9
    assert np.isnan(judged.rows[0].errors.rotation)


def test_a_column_map_beside_or_above_gives_the_source(validated, files, tmp_path):
    (tmp_path / "columns.toml").write_text('source = "sim:x"\n[legs]\n')
    assert validated(*files)[1].source == "sim:x"
    (tmp_path / "below").mkdir()
    _, judged = validated(*[file.rename(tmp_path / "below" / file.name) for file in files])
    assert judged.source == "sim:x"
    assert any("source, sim:x, is stated in" in note for note in judged.notes)


def test_a_guess_that_nobody_checked_and_a_section_that_is_no_table_are_refused(
    validated, files, tmp_path
):
    map_of = tmp_path / "columns.toml"
    for text, message in (
        ('[track.columns]\nx_m = {name = "east?", unit = "mm?"}\n', "guesses .*x_m.*name"),
        ("track = 3\n", "expected a section"),
    ):
        map_of.write_text(text)
        with pytest.raises(SettingsError, match=message):
            validated(*files)
    with pytest.raises(NotFound, match=r"other\.toml"):
        validated(*files, columns=tmp_path / "other.toml")


@pytest.fixture
def log(tmp_path):
    """Return a bag with a path on two topics, the second 0.5 m off."""
    bags = pytest.importorskip("support.written_bags", reason="rosbags is an extra")
    path = np.column_stack([0.1 * T, 0.05 * T**2, 0.1 * T])
    shifted = path + np.array([0.3, 0.4, 0.0])
    parts = bags.stamped(T, path, topic="/truth"), bags.odometry(T, shifted)
    return bags.write_bag(tmp_path / "log", *parts)


def test_two_topics_of_a_ros_log_are_validated(validated, log):
    manifest, judged = validated(log, log, topic=("/truth", "/odom"))
    for row in judged.rows:
        assert row.errors.ate.rms == pytest.approx(0.5, abs=1e-7)
        assert row.errors.aligned.rms == pytest.approx(0.0, abs=1e-6)
    assert manifest["layouts"] == ["ros", "ros"]
    assert any(name.endswith("metadata.yaml") for name in manifest["inputs"])


@pytest.mark.parametrize(
    ("topic", "how", "message"),
    [
        ((), {}, "topics /odom, /truth; .*--topic"),
        (("/trut",), {}, "/trut; did you mean '/truth'"),
        (("/odom",), {"layout": (Layout.TUM,)}, "--layout: .*leave the option out"),
    ],
)
def test_what_a_ros_log_leaves_open_is_asked_for(validated, log, tmp_path, topic, how, message):
    with pytest.raises((DataError, SettingsError), match=message):
        validated(log, log, topic=topic, trajectory=TrajectoryRequest(**how))
    assert not (tmp_path / "out").exists()


@pytest.fixture(scope="module")
def pair():
    """Return a drive, and a noisy part of it in another frame, at other times and scale."""
    t, position, rotation = drive(80)
    _, rough, turned = drive(80, noise=0.05, seed=2)
    kept = np.arange(4, 77, 3)
    late = t[kept] + np.random.default_rng(3).uniform(-0.004, 0.004, len(kept))
    return (t, position, rotation), (late, 0.6 * rough[kept] + 0.1, turned[kept]), turned, rough


@pytest.fixture(scope="module")
def evo_files():
    pytest.importorskip("evo", reason="evo is an extra: pip install evo")
    from evo.tools import file_interface

    return file_interface


def evo_errors(reference, estimate, *, scale=False, distance=None) -> dict[str, float]:
    """Return evo's errors by column of `metrics.csv`."""
    from evo.core.metrics import APE, RPE, PoseRelation, StatisticsType, Unit

    def rmse(metric) -> float:
        metric.process_data((reference, estimate))
        return metric.get_statistic(StatisticsType.rmse)

    estimate = copy.deepcopy(estimate)
    if scale:
        estimate.align(reference, correct_only_scale=True, correct_scale=True)
    errors = {"ate_m": rmse(APE(PoseRelation.translation_part))}
    for unit, part in (
        ("m", PoseRelation.translation_part),
        ("deg", PoseRelation.rotation_angle_deg),
    ):
        errors[f"rpe_step_{unit}"] = rmse(RPE(part))
        over = RPE(part, distance, Unit.meters, all_pairs=True, pairs_from_reference=True)
        errors[f"rpe_{distance:g}m_{unit}"] = rmse(over)
    errors["rotation_rms_deg"] = rmse(APE(PoseRelation.rotation_angle_deg))
    estimate.align(reference)
    errors["ate_aligned_m"] = rmse(APE(PoseRelation.translation_part))
    return errors


def agree(ours, theirs):
    assert {name: ours[name] for name in theirs} == pytest.approx(theirs, rel=1e-5)


@pytest.mark.parametrize(("form", "scale"), [("tum", False), ("tum", True), ("euroc", False)])
def test_evo_agrees_on_files_with_times(validated, evo_files, tmp_path, pair, form, scale):
    from evo.core.sync import associate_trajectories

    (t, *truth), (late, *rough), *_ = pair
    read_tum = evo_files.read_tum_trajectory_file
    text, read = {"tum": (tum, read_tum), "euroc": (euroc, evo_files.read_euroc_csv_trajectory)}[
        form
    ]
    first = written(tmp_path / "truth.csv", text(UNIX + t, *truth))
    second = written(tmp_path / "rough.txt", tum(UNIX + late, *rough))
    ours = validated(first, second, distance=(1.0,), correct_scale=scale)[0]["metrics"]
    both = associate_trajectories(read(str(first)), read_tum(str(second)), max_diff=0.01)
    assert ours["space"]["poses"] == both[0].num_poses == 25
    agree(ours["space"], evo_errors(*both, scale=scale, distance=1.0))
    if not scale:
        own = [read_tum(str(tmp_path / f"out/{name}.tum")) for name in ("reference", "estimate")]
        agree(ours["plane xy"], evo_errors(*own, distance=1.0))


def frame_of(plane: str) -> Rotation:
    """Return the rotation from the frame of the floor to one whose `plane` is the floor."""
    first, second = ("xyz".index(axis) for axis in plane)
    rows = np.zeros((3, 3))
    rows[first, 0] = rows[second, 1] = 1.0
    rows[3 - first - second] = np.cross(rows[:, 0], rows[:, 1])[3 - first - second] * np.eye(3)[2]
    return Rotation.from_matrix(rows)


@pytest.mark.parametrize("plane", ["xy", "xz", "zy"])
def test_evo_agrees_on_kitti_files(validated, evo_files, tmp_path, pair, plane):
    """A flat path that fits better turned over is turned over by evo in space, but not by us."""
    (_, position, rotation), _, turned, rough = pair
    frame, move = frame_of(plane), Rotation.from_rotvec([0.0, 0.0, 0.9])
    first = written(tmp_path / "truth.txt", kitti(frame.apply(position), frame * rotation))
    turned, rough = frame * move * turned, frame.apply(move.apply(rough))
    second = written(tmp_path / "rough.txt", kitti(rough, turned))
    how = TrajectoryRequest(plane=Plane(plane))
    ours = validated(first, second, distance=(2.0,), trajectory=how)[0]["metrics"]
    both = [evo_files.read_kitti_poses_file(str(file)) for file in (first, second)]
    agree(ours["space"], evo_errors(*both, distance=2.0))
    own = [evo_files.read_tum_trajectory_file(str(tmp_path / f"out/{name}.tum"))
           for name in ("reference", "estimate")]  # fmt: skip
    agree(ours[f"plane {plane}"], evo_errors(*own, distance=2.0))
