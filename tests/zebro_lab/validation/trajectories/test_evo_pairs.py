# SPDX-License-Identifier: MIT
"""evo, a peer, finds our errors in the same files of TUM, KITTI and EuRoC, and in our own."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from support.foreign_trajectories import drive, euroc, kitti, tum, written

pytest.importorskip("evo", reason="evo is an extra: pip install evo")
from evo.core.metrics import APE, RPE, PoseRelation, StatisticsType, Unit
from evo.core.sync import associate_trajectories
from evo.tools import file_interface as evo_files

UNIX = 1_400_000_000.0


@pytest.fixture(scope="module")
def pair():
    """Return a drive, and a noisy part of it in another frame, at other times and scale."""
    t, position, rotation = drive(80)
    _, rough, turned = drive(80, noise=0.05, seed=2)
    kept = np.arange(4, 77, 3)
    late = t[kept] + np.random.default_rng(3).uniform(-0.004, 0.004, len(kept))
    return (t, position, rotation), (late, 0.6 * rough[kept] + 0.1, turned[kept]), turned, rough


def rmse(metric, reference, estimate) -> float:
    metric.process_data((reference, estimate))
    return metric.get_statistic(StatisticsType.rmse)


def evo_errors(reference, estimate, *, scale=False, distance=None) -> dict[str, float]:
    """Return evo's errors by column of `metrics.csv`."""
    import copy

    estimate = copy.deepcopy(estimate)
    if scale:
        estimate.align(reference, correct_only_scale=True, correct_scale=True)
    errors = {"ate_m": rmse(APE(PoseRelation.translation_part), reference, estimate)}
    for unit, part in (
        ("m", PoseRelation.translation_part),
        ("deg", PoseRelation.rotation_angle_deg),
    ):
        errors[f"rpe_step_{unit}"] = rmse(RPE(part), reference, estimate)
        if distance is not None:
            over = RPE(part, distance, Unit.meters, all_pairs=True, pairs_from_reference=True)
            errors[f"rpe_{distance:g}m_{unit}"] = rmse(over, reference, estimate)
    errors["rotation_rms_deg"] = rmse(APE(PoseRelation.rotation_angle_deg), reference, estimate)
    estimate.align(reference)
    errors["ate_aligned_m"] = rmse(APE(PoseRelation.translation_part), reference, estimate)
    return errors


def validated(run_command, tmp_path, *arguments) -> dict[str, dict[str, float]]:
    ended = run_command("validate", *arguments, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    return json.loads((tmp_path / "out/manifest.json").read_text())["metrics"]


def agree(ours, theirs):
    assert {name: ours[name] for name in theirs} == pytest.approx(theirs, rel=1e-5)


def own(tmp_path):
    read = evo_files.read_tum_trajectory_file
    return [read(str(tmp_path / "out" / f"{name}.tum")) for name in ("reference", "estimate")]


@pytest.mark.parametrize("scale", [False, True])
@pytest.mark.parametrize("form", ["tum", "euroc"])
def test_evo_agrees_on_files_with_times(run_command, tmp_path, pair, form, scale):
    (t, *truth), (late, *rough), *_ = pair
    text, read = {
        "tum": (tum, evo_files.read_tum_trajectory_file),
        "euroc": (euroc, evo_files.read_euroc_csv_trajectory),
    }[form]
    first = written(tmp_path / "truth.csv", text(UNIX + t, *truth))
    second = written(tmp_path / "rough.txt", tum(UNIX + late, *rough))
    more = ["--correct-scale"] if scale else []
    ours = validated(run_command, tmp_path, first, second, "--distance", 1, *more)
    both = associate_trajectories(
        read(str(first)), evo_files.read_tum_trajectory_file(str(second)), max_diff=0.01
    )
    assert ours["space"]["poses"] == both[0].num_poses == 25
    agree(ours["space"], evo_errors(*both, scale=scale, distance=1.0))
    if not scale:
        agree(ours["plane xy"], evo_errors(*own(tmp_path), distance=1.0))


def frame_of(plane: str) -> Rotation:
    """Return the rotation from the frame of the floor to one whose `plane` is the floor."""
    first, second = ("xyz".index(axis) for axis in plane)
    rows = np.zeros((3, 3))
    rows[first, 0] = rows[second, 1] = 1.0
    rows[3 - first - second] = np.cross(rows[:, 0], rows[:, 1])[3 - first - second] * np.eye(3)[2]
    return Rotation.from_matrix(rows)


@pytest.mark.parametrize("plane", ["xy", "xz", "zy"])
def test_evo_agrees_on_kitti_files(run_command, tmp_path, pair, plane):
    """A flat path that fits better turned over is turned over by evo in space, but not by us."""
    (_, position, rotation), _, turned, rough = pair
    frame, move = frame_of(plane), Rotation.from_rotvec([0.0, 0.0, 0.9])
    first = written(tmp_path / "truth.txt", kitti(frame.apply(position), frame * rotation))
    turned, rough = frame * move * turned, frame.apply(move.apply(rough))
    second = written(tmp_path / "rough.txt", kitti(rough, turned))
    ours = validated(run_command, tmp_path, first, second, "--distance", 2, "--plane", plane)
    both = [evo_files.read_kitti_poses_file(str(file)) for file in (first, second)]
    agree(ours["space"], evo_errors(*both, distance=2.0))
    agree(ours[f"plane {plane}"], evo_errors(*own(tmp_path), distance=2.0))
