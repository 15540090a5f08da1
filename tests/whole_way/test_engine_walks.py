# SPDX-License-Identifier: MIT
"""Walks of an independent engine, imported and predicted by commands, turn as the study says."""

import numpy as np
import pandas as pd
import pytest

from benchmarks.accuracy.engine_walks import by_dynamics, figures, radius, read_walk

COLUMNS = (
    """
source = "sim:engine"
[legs.columns]
"""
    + "".join(f'theta{leg}.name = "th{leg}"\n' for leg in range(1, 7))
    + """[track.columns]
t_s.name = "t"
x_m.name = "x"
y_m.name = "y"
yaw_rad.name = "yaw"
"""
)
SAME = 2e-3  # of a radius: the command walks by smaller steps than the study


@pytest.mark.reference
@pytest.mark.parametrize(
    "name",
    [
        "tripod_s1.30_right_mu0.38_tc2",
        pytest.param("tripod_s1.10_left_mu0.38_tc1", marks=pytest.mark.long),
        pytest.param("tripod_s1.20_left_mu0.20_tc2", marks=pytest.mark.long),
        pytest.param("tripod_s1.30_left_mu0.38_tc2_arc200real", marks=pytest.mark.long),
    ],
)
def test_an_imported_walk_turns_as_in_the_study(name, shared, command, tmp_path):
    file = shared / "virtual-world/walks" / f"{name}.json"
    one, table = read_walk(file), file.with_suffix(".csv.gz")
    (tmp_path / "columns.toml").write_text(COLUMNS)
    command("import", "--legs", table, "--track", table, "--columns", tmp_path / "columns.toml",
            "--label", "engine", "--data", tmp_path / "data")  # fmt: skip
    (run,) = (tmp_path / "data").iterdir()
    arc = np.degrees(one.robot.leg_arc)
    robot = tmp_path / "robot.toml"
    robot.write_text(f"[legs]\narc_deg = {arc}\n")
    command("predict", run, "--slip", f"coulomb:{one.friction}", "--robot", robot)
    command("validate", run)
    path = pd.read_csv(run / "prediction/path.csv")
    by_command = radius(path["t"].to_numpy(), path[["x", "y"]].to_numpy(), path["yaw"].to_numpy(),
                        one.period)  # fmt: skip
    study = by_dynamics(one)
    by_study = radius(study.t, study.position[:, :2], study.yaw, one.period)
    assert by_command == pytest.approx(by_study, rel=SAME), figures(one, by_dynamics)
    judged = pd.read_csv(run / "validation/metrics.csv").set_index("model").loc["prediction"]
    t, yaw, xy = (one.truth[c].to_numpy() for c in ("t", "yaw", ["x", "y"]))
    true = radius(t, xy, yaw, one.period)
    assert judged["radius_tracked_m"] == pytest.approx(true, rel=0.01)
    assert judged["radius_m"] == pytest.approx(by_study, rel=0.01)
