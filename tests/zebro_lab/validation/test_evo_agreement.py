# SPDX-License-Identifier: MIT
"""evo, a peer, finds our errors in the TUM files of a validation."""

import numpy as np
import pandas as pd
import pytest

from support.watchers import Nobody
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate

pytest.importorskip("evo", reason="evo is an extra: pip install evo")
from evo.core.metrics import APE, RPE, PoseRelation, StatisticsType, Unit
from evo.core.sync import associate_trajectories
from evo.tools.file_interface import read_tum_trajectory_file


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """Judge a circle against a wider one, seen with noise; return the errors and the folder."""
    folder = tmp_path_factory.mktemp("evo")
    t = np.linspace(0.0, 30.0, 601)
    for name, radius, keep in (("path", 1.9, slice(None)), ("track", 2.0, slice(0, None, 20))):
        yaw = 0.1 * t / 2.0
        xy = radius * np.column_stack([np.sin(yaw), 1 - np.cos(yaw)])
        rng = np.random.default_rng(1)
        noise = 0.0 if name == "path" else rng.normal(0, 0.003, (len(t), 3))
        table = pd.DataFrame(np.column_stack([xy, yaw]) + noise, columns=["x", "y", "yaw"])
        table.insert(0, "t", t)
        table.iloc[keep].to_csv(folder / f"{name}.csv", index=False)
    pair = {"predicted": (folder / "path.csv",), "track": (folder / "track.csv",)}
    done = validate(ValidateRequest(**pair, out=folder / "out"), Nobody())
    return done.runs[0].rows[0].errors, folder / "out"


def trajectories(folder):
    files = [next(folder.glob(f"*.{which}.tum")) for which in ("track", "predicted")]
    return associate_trajectories(*(read_tum_trajectory_file(str(file)) for file in files))


def rmse(metric, pair):
    metric.process_data(pair)
    return metric.get_statistic(StatisticsType.rmse)


def test_evo_finds_the_same_unaligned_error(judged):
    errors, folder = judged
    assert rmse(APE(PoseRelation.translation_part), trajectories(folder)) == pytest.approx(
        errors.ate, rel=1e-4
    )


def test_evo_finds_the_same_aligned_error(judged):
    """Both paths are planar, so evo's alignment in space is ours in the plane."""
    errors, folder = judged
    reference, predicted = trajectories(folder)
    predicted.align(reference)
    assert rmse(APE(PoseRelation.translation_part), (reference, predicted)) == pytest.approx(
        errors.ate_aligned, rel=1e-3
    )


def test_evo_finds_the_same_error_of_heading(judged):
    errors, folder = judged
    assert rmse(APE(PoseRelation.rotation_angle_rad), trajectories(folder)) == pytest.approx(
        errors.yaw, rel=1e-3
    )


def test_evo_finds_the_same_relative_error_over_single_steps(judged):
    """evo counts poses where we count metres: a step of the track is 0.1 m."""
    errors, folder = judged
    reference, predicted = trajectories(folder)
    step = rmse(RPE(PoseRelation.translation_part, 5, Unit.frames), (reference, predicted))
    ours = next(each for each in errors.relative if each.distance == 0.5)
    assert step == pytest.approx(ours.position, rel=0.15)
