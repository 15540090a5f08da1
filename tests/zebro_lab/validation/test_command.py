# SPDX-License-Identifier: MIT
"""`zebro-lab validate` prints errors, bands and what is simulated."""

import json

import pytest

from support.foreign_trajectories import drive, tum, written
from zebro_lab.validation.predicted_walks import pairs_of_run

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_command_prints_a_table_and_says_simulated(walk, tmp_path, run_command):
    prediction, track = pairs_of_run(walk)
    arguments = ["--predicted", prediction, "--track", track, "--out", tmp_path / "out"]
    ended = run_command("validate", *arguments)
    assert ended.code == 0
    printed = ended.out
    assert "SIMULATED" in printed
    assert "no-slip-simple" in printed
    assert "coverage of the 90% band: x " in printed
    assert "predicted uncertainty (NEES)" in printed


def test_json_is_the_manifest_of_the_folder_with_verdict_of_the_source(walk, tmp_path, run_command):
    prediction, track = pairs_of_run(walk)
    arguments = ["--predicted", prediction, "--track", track, "--out", tmp_path / "out"]
    ended = run_command("validate", *arguments, "--json", "--quiet")
    document = json.loads(ended.out)
    assert (ended.code, ended.err) == (0, "")
    assert (document["command"], document["exit_code"], document["simulated"]) == (
        "validate", 0, True,
    )  # fmt: skip
    assert document["validation"] == json.loads((tmp_path / "out" / "manifest.json").read_text())


@pytest.fixture
def files(tmp_path):
    for name in ("truth.txt", "slam.txt"):
        written(tmp_path / name, tum(*drive()))
    return tmp_path / "truth.txt", tmp_path / "slam.txt"


def test_two_trajectories_are_a_table_and_a_folder(run_command, files, tmp_path):
    ended = run_command("validate", *files, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    for expected in ("absolute error (ATE), rms", "plane xy", "space", "60 of 60", "out"):
        assert expected in ended.out
    ended = run_command("validate", files[0], tmp_path / "none.txt")
    assert ended.code == 1
    assert "none.txt: no such file" in ended.err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["truth.txt", "slam.txt", "third.txt"], "3 paths; give run folders, or two files"),
        (["truth.txt", "."], "is a folder"),
        ([".", "--correct-scale"], "belongs to two trajectories"),
        *(
            (["truth.txt", "slam.txt", *more], message)
            for more, message in (
                (["--predicted", "p", "--track", "t"], "belongs to predicted walks"),
                (["--no-anchor"], "belongs to predicted walks"),
                (["--plane", "xx"], "xx"),
                (["--topic", "/odom"], "--topic: belongs to ROS logs; no file is one"),
                (["--max-difference", "-1"], "--max-difference"),
            )
        ),
        (["--predicted", "p"], "1 --predicted and 0 --track"),
        ([".", "--estimate-offset", "--time-offset", "1"], "not both"),
    ],
)
def test_wrong_usage_ends_with_2(run_command, files, arguments, message, monkeypatch):
    monkeypatch.chdir(files[0].parent)
    ended = run_command("validate", *arguments)
    assert ended.code == 2
    assert message in " ".join(ended.err.replace("│", " ").split())
