# SPDX-License-Identifier: MIT
"""`zebro-lab predict` takes leg logs and walked paths, and names what is wrong in them."""

import numpy as np
import pytest

from support.walk_requests import write_log
from zebro_lab.walk.folder import read_walk_manifest


def test_predict_takes_what_walk_wrote(run_command, tmp_path):
    walk = tmp_path / "walk"
    asked = ("walk", "--slip", "coulomb:0.4", "--duration", 3, "--out", walk)
    assert run_command(*asked).code == 0
    ended = run_command("predict", walk, "--model", "no-slip", "--out", tmp_path / "predicted")
    assert ended.code == 0
    assert "logged leg angles, model 'no-slip'" in ended.out
    assert "straight ahead" in ended.out


def test_leg_log_with_a_gap_is_one_line_with_its_place(run_command, tmp_path):
    log = tmp_path / "legs.csv"
    rows = [f"{t / 100},{','.join([str(t / 50)] * 6)}" for t in (*range(30), *range(60, 90))]
    log.write_text("\n".join(["t,theta1,theta2,theta3,theta4,theta5,theta6", *rows]) + "\n")
    ended = run_command("predict", log, "--slip", "thesis", "--out", tmp_path / "out")
    assert ended.code == 1
    assert ended.err.startswith(f"error: {log}, column 't', row 31 (line 32): time jumps from 0.29")


def test_options_reach_the_prediction_and_its_folder(run_command, tmp_path):
    log = write_log(tmp_path)
    (tmp_path / "robot.toml").write_text("mass = 3.0\n[legs]\narc_deg = 200\n")
    out = tmp_path / "out"
    ended = run_command("predict", log, "--model", "no-slip-simple", "--dt", "0.02", "--robot",
                        tmp_path / "robot.toml", "--direction", "right",
                        "--out", out)  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    assert "SIMULATED walk: " in ended.out
    assert str(out / "path.csv") in ended.out
    settings = read_walk_manifest(out)["settings"]
    assert (settings["model"], settings["dt"], settings["direction"]) == (
        "no-slip-simple", 0.02, "right",
    )  # fmt: skip
    assert settings["robot"]["mass"] == 3.0
    assert settings["robot"]["leg_arc"] == pytest.approx(np.radians(200))


def test_a_band_without_a_model_of_slip_and_a_missing_law_are_named(run_command, tmp_path):
    log = write_log(tmp_path)
    given = ("predict", log, "--out", tmp_path / "out")
    ended = run_command(*given, "--model", "no-slip-simple", "--draws", 5)
    assert ended.code == 2
    assert "--draws: a band is predicted by the model 'dynamics' only" in ended.err
    assert run_command(*given).code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("address", "problem"),
    [("here", "expected tcp://HOST:PORT"), ("tcp://8.8.8.8:8786", "outside of this machine")],
)
@pytest.mark.parametrize("name", ["predict none.csv", "walk --duration 2"])
def test_a_scheduler_that_cannot_be_used_is_told_before_anything_is_read(
    run_command, tmp_path, name, address, problem
):
    out = tmp_path / "out"
    ended = run_command(
        *name.split(), "--slip", "none.toml", "--draws", 2, "--out", out, "--scheduler", address
    )
    assert ended.code == 2
    assert "--scheduler" in ended.err
    assert problem in ended.err
    assert not out.exists()
