# SPDX-License-Identifier: MIT
"""Two of a kind over each other: what differs is said, with how surely."""

import json

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import AlreadyExists, DataError, NotFound, SettingsError
from zebro_lab.main import app
from zebro_lab.terminal.ending import run as run_app
from zebro_lab.validation.compare.request import CompareRequest
from zebro_lab.validation.compare.runs import compare_runs
from zebro_lab.validation.compare.stage import compare

SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "{definition}"
law = {{ name = "coulomb-stribeck", stribeck = false }}
[parameters]
slip_stiffness = {{ mean = 20.0 }}
friction = {{ mean = {friction} }}
[covariance]
matrix = [[1.0, 0.0], [0.0, {variance}]]
[tested]
normal_force = {loads}
slip_ratio = [0.0, 1.0]
"""


def calibration(folder, *, friction=0.4, sd=0.01, definition="material", loads=(2.0, 13.0)):
    folder.mkdir(parents=True)
    text = SLIP_TOML.format(
        definition=definition, friction=friction, variance=sd**2, loads=list(loads)
    )
    (folder / "slip.toml").write_text(text)
    return folder


def run_folder(folder, *, radius=2.0, speed=0.08, sd=0.002, seed=1, yaw=True):
    """Write a run with a track of a circle, walked and turned to somewhere on the floor."""
    (folder / "track").mkdir(parents=True)
    t = np.arange(0.0, 30.0, 2.0)
    turned = speed * t / radius
    heading = turned + 0.7
    position = radius * np.column_stack([np.sin(turned), 1 - np.cos(turned)])
    c, s = np.cos(0.7), np.sin(0.7)
    rng = np.random.default_rng(seed)
    noise = rng.normal(0, sd, (len(t), 3))
    table = pd.DataFrame({
        "t_s": t, "x_m": 1 + c * position[:, 0] - s * position[:, 1] + noise[:, 0],
        "y_m": s * position[:, 0] + c * position[:, 1] + noise[:, 1],
        "cov_xx": sd**2, "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yy": sd**2, "cov_yyaw": 0.0,
        "cov_yawyaw": sd**2,
    })  # fmt: skip
    if yaw:
        table["yaw_rad"] = heading + noise[:, 2]
    table.to_csv(folder / "track" / "track.csv", index=False)
    return folder


def compared(first, second, out):
    done = compare(CompareRequest(first, second, out))
    return done, dict(
        zip([q.name for q in done.comparison.quantities], done.differences, strict=True)
    )


def test_more_friction_is_more_traction_and_the_same_slope(tmp_path):
    one = calibration(tmp_path / "one")
    other = calibration(tmp_path / "other", friction=0.44)
    _, by_name = compared(one, other, tmp_path / "out")
    traction = by_name["largest traction over load at 7.5 N"]
    assert traction.median == pytest.approx(0.04, abs=0.005)
    # 0.04 apart, each with a standard deviation of 0.01.
    assert traction.probability == pytest.approx(0.9977, abs=0.004)
    assert traction.clear
    slope = by_name["initial slope over load at 7.5 N"]
    assert not slope.clear
    assert slope.probability == pytest.approx(0.5, abs=0.05)


def test_the_folder_holds_a_table_a_picture_and_where_it_comes_from(tmp_path):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", friction=0.5)
    compared(one, other, tmp_path / "out")
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    assert manifest["kind"] == "comparison"
    assert manifest["of"] == "calibrations"
    assert manifest["source"] == "sim:rig-sweep"
    assert set(manifest["inputs"]) == {str(folder / "slip.toml") for folder in (one, other)}
    assert set(manifest["outputs"]) == {"comparison.csv", "comparison.png"}
    table = pd.read_csv(tmp_path / "out/comparison.csv")
    assert len(table) == len(manifest["quantities"])


def test_a_tighter_turn_is_told_from_a_wide_one_wherever_it_was_walked(tmp_path):
    one, other = run_folder(tmp_path / "a"), run_folder(tmp_path / "b", radius=1.9, seed=2)
    done, by_name = compared(one, other, tmp_path / "out")
    assert done.comparison.kind == "runs"
    curvature = by_name["curvature, tracked"]
    assert curvature.median == pytest.approx(1 / 1.9 - 1 / 2.0, rel=0.2)
    assert curvature.clear
    assert not by_name["speed, tracked"].clear
    start = done.comparison.paths[0].track
    np.testing.assert_allclose([*start.position[0], start.yaw[0]], 0, atol=1e-12)


def test_runs_that_differ_by_noise_alone_are_not_told_apart_more_often_than_stated(tmp_path):
    told = 0
    for seed in range(20):
        one = run_folder(tmp_path / f"a{seed}", seed=seed)
        other = run_folder(tmp_path / f"b{seed}", seed=100 + seed)
        rng = np.random.default_rng(seed)
        quantities = compare_runs(one, other, names=("a", "b"), rng=rng).quantities
        rate = next(each for each in quantities if each.name == "yaw rate, tracked")
        told += rate.difference(rng).clear
    assert told <= 6  # of 20 at 10 %: more comes once in 400


@pytest.mark.parametrize(
    ("options", "problem"),
    [({"definition": "travel"}, "no axis"), ({"loads": (20.0, 30.0)}, "no load is common")],
)
def test_calibrations_without_anything_in_common_are_refused(tmp_path, options, problem):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", **options)
    with pytest.raises(DataError, match=problem):
        compare(CompareRequest(one, other, tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_compared_is_named(tmp_path):
    slip, run = calibration(tmp_path / "slip"), run_folder(tmp_path / "run")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SettingsError, match="two of a kind"):
        compare(CompareRequest(slip, run, tmp_path / "out"))
    with pytest.raises(NotFound, match="holds no"):
        compare(CompareRequest(slip, tmp_path / "empty", tmp_path / "out"))
    with pytest.raises(SettingsError, match="with itself"):
        compare(CompareRequest(slip, slip, tmp_path / "out"))
    blind = run_folder(tmp_path / "blind", yaw=False)
    with pytest.raises(DataError, match="nothing is common"):
        compare(CompareRequest(run, blind, tmp_path / "out"))
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken/manifest.json").write_text('{"kind": "track"}')
    with pytest.raises(AlreadyExists, match="another command"):
        compare(CompareRequest(slip, slip, tmp_path / "taken"))


def test_the_command_prints_probabilities_and_says_simulated(tmp_path, monkeypatch, capsys):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", friction=0.5)
    arguments = ["compare", str(one), str(other), "--out", str(tmp_path / "out")]
    monkeypatch.setattr("sys.argv", ["zebro-lab", *arguments])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    printed = capsys.readouterr().out
    assert not ended.value.code
    assert "SIMULATED" in printed
    assert "P(other is larger)" in printed
    assert "100.0% *" in printed


def test_a_name_that_looks_like_markup_is_shown_as_it_is(tmp_path, monkeypatch, capsys):
    one, other = calibration(tmp_path / "[bold]one"), calibration(tmp_path / "[z]b", friction=0.5)
    arguments = ["compare", str(one), str(other), "--out", str(tmp_path / "out")]
    monkeypatch.setattr("sys.argv", ["zebro-lab", *arguments])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    assert not ended.value.code
    printed = capsys.readouterr().out
    assert "P([z]b is larger)" in printed
    assert "[bold]one" in printed
