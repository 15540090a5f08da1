# SPDX-License-Identifier: MIT
"""`calibrate-slip` needs something to fit, and begins no fit that cannot be finished."""

import shutil

import pytest

from support.tracked_walks import write_walk
from zebro_lab.main import slip_app as app
from zebro_lab.terminal.ending import run as run_app
from zebro_lab.walk_fit import command


def test_the_command_needs_rig_data_or_walks(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["calibrate-slip"])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    assert ended.value.code == 2
    assert "missing: rig data" in capsys.readouterr().err


def missing_walk(folder):
    return ("--walks", folder / "none"), "none: no such folder"


def walk_without_track(folder):
    walk = write_walk(folder / "walk")
    shutil.rmtree(walk / "track")
    return ("--walks", walk), "no track"


def somebodys_walks_folder(folder):
    (folder / "calibration/walks").mkdir(parents=True)
    (folder / "calibration/walks/walks.toml").write_text("mine")
    return ("--walks", write_walk(folder / "walk")), "walks.toml exists and is not replaced"


@pytest.mark.parametrize(
    "case",
    [
        missing_walk, walk_without_track, somebodys_walks_folder
    ],
)  # fmt: skip
def test_walks_that_cannot_be_fitted_are_refused_before_the_fit_of_rig_data(
    case, tmp_path, monkeypatch, capsys
):
    arguments, problem = case(tmp_path)
    monkeypatch.setattr(command, "fit_and_report", lambda *_, **__: pytest.fail("the fit began"))
    given = ("calibrate-slip", tmp_path, *arguments, "--out", tmp_path / "calibration")
    monkeypatch.setattr("sys.argv", [*map(str, given)])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    assert ended.value.code == 1
    assert problem in capsys.readouterr().err


@pytest.mark.parametrize(
    ("address", "problem"),
    [("here", "expected tcp://HOST:PORT"), ("tcp://8.8.8.8:8786", "outside of this machine")],
)
def test_a_scheduler_that_cannot_be_used_is_told_before_anything_is_read(
    run_command, tmp_path, address, problem
):
    out = tmp_path / "calibration"
    ended = run_command("calibrate-slip", "none", "--out", out, "--scheduler", address)
    assert ended.code == 2
    assert problem in ended.err
    assert not out.exists()
