# SPDX-License-Identifier: MIT
"""`zebro-lab camera`, `track` and `annotate` as their user meets them."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from zebro_lab.main import app
from zebro_lab.terminal.ending import run as run_app
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera.clock_screen import code_lines
from zebro_lab.track.command import MergedAs

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))
WALK = Path(__file__).parents[3] / "datasets/walk-sim"
PHOTOS = WALK / "photos"


@pytest.fixture
def run(monkeypatch, capsys):
    """Return a runner of the command in this process: exit code, stdout, stderr."""

    def runner(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", [COMMAND, *map(str, arguments)])
        try:
            with pytest.raises(SystemExit) as ended:
                run_app(app)
            code = ended.value.code
        finally:
            streams = capsys.readouterr()
        return int(code or 0), streams.out, streams.err

    return runner


@pytest.fixture
def bench(tmp_path) -> Path:
    """Return a folder with camera.toml and floor.toml for the bundled photographs."""
    for name in ("camera.toml", "floor.toml"):
        shutil.copy(WALK / name, tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "command", [("track",), ("annotate",), ("camera",), ("camera", "calibrate"), ("camera", "kit")]
)
def test_help_loads_nothing_heavy(command):
    process = subprocess.run(
        [sys.executable, "-X", "importtime", COMMAND, *command, "--help"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "Usage: " in process.stdout
    loaded = {line.rsplit("|", 1)[-1].strip() for line in process.stderr.splitlines()}
    assert not loaded & {"numpy", "scipy", "pandas", "matplotlib", "cv2", "PIL", "tracking"}


def test_preview_in_a_pipe_says_what_is_seen_and_draws_it(bench):
    process = subprocess.run(
        [COMMAND, "track", str(PHOTOS), "--camera", "camera.toml", "--floor", "floor.toml",
         "--robot", str(WALK / "robot.toml"), "--preview", "preview.png"],
        capture_output=True, text=True, check=False, cwd=bench,
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    assert process.stderr == ""
    for part in ("marks 10, 11, 12, 13 are seen", "a pixel is ", "10 to 11: tape 1.7000 m"):
        assert part in process.stdout
    assert (bench / "preview.png").is_file()


def test_a_wrong_tape_is_pointed_at(run, bench):
    floor = bench / "floor.toml"
    floor.write_text(floor.read_text().replace("x = 2.2", "x = 2.215"))
    code, out, err = run(
        "track", PHOTOS, "--camera", bench / "camera.toml", "--floor", floor,
        "--robot", WALK / "robot.toml", "--preview", bench / "preview.png",
    )  # fmt: skip
    assert code == 0
    assert "<-- off" in out
    assert "measure the floor again" in err


def test_a_board_is_calibrated_and_coverage_shown(run, tmp_path):
    code, out, _ = run(
        "camera", "calibrate", WALK / "calibration", "--board", "charuco:9x6:40mm:30mm:4x4_50",
        "--out", tmp_path / "camera.toml",
    )  # fmt: skip
    assert code == 0
    assert re.search(r"fx 150\d\.\d\d ± 0\.\d\d px", out)
    assert "  # # # # # # # #\n" in out
    assert (tmp_path / "camera.toml").is_file()


ERRORS = {
    "no such photographs": (("nowhere",), "nowhere: no such folder, video or picture"),
    "no camera": ((PHOTOS, "--camera", "none.toml"), "none.toml: no such file"),
    "no such marker": ((PHOTOS, "--marker", "zero"), "--marker: 'zero' is no marker"),
    "unknown dictionary": ((PHOTOS, "--marker", "4x4_51:0:1mm"), "did you mean '4x4_50'"),
    "no robot's height": ((PHOTOS, "--robot", "robot.toml"), "marker.height: missing"),
    "two sources of time": ((PHOTOS, "--interval", "2", "--times", "t.csv"), "--times: not toge"),
    "no unit": ((PHOTOS, "--body-height", "6 kg"), "unit 'kg'"),
    "no such clock": ((PHOTOS, "--clock", "clock.jpg"), "clock.jpg: no such file"),
    "no annotations": ((PHOTOS, "--without-marker"), "annotate PHOTOS"),
}  # fmt: skip


@pytest.mark.parametrize(("arguments", "message"), ERRORS.values(), ids=ERRORS)
def test_an_error_is_one_line_and_exit_1_and_nothing_is_written(
    arguments, message, run, bench, monkeypatch
):
    monkeypatch.chdir(bench)
    Path("robot.toml").write_text("[marker]\nposition = [0, 0, 0.0385]\n")
    robot = () if "--robot" in arguments else ("--robot", WALK / "robot.toml")
    camera = () if "--camera" in arguments else ("--camera", "camera.toml")
    given = ("track", *arguments, *robot, *camera, "--floor", "floor.toml", "--out", "out")
    code, out, err = run(*given)
    assert (code, out) == (1, "")
    assert err.startswith("error: ")
    assert message in err
    assert err.count("\n") == 1
    assert not Path("out").exists()


def test_nowhere_to_write_and_nothing_to_say_are_wrong_usage(run, bench):
    code, _, err = run("track", PHOTOS, "--camera", bench / "camera.toml", "--floor",
                       bench / "floor.toml")  # fmt: skip
    assert code == 2
    assert "--out FOLDER" in err
    code, _, err = run("annotate", PHOTOS, "--out", bench / "said.toml")
    assert code == 2
    assert "nothing is said" in err


def test_how_a_composite_was_merged_is_asked_for_with_a_line_for_each_way(run, bench):
    composite = WALK / "composite/simulated_pasted.jpg"
    code, _, err = run(
        "track", composite, "--camera", bench / "camera.toml", "--floor", bench / "floor.toml",
        "--robot", WALK / "robot.toml", "--interval", "4", "--out", bench / "out",
    )  # fmt: skip
    assert code == 2
    assert "'--merged'" in err
    for kind in MergedAs:
        assert f"\n{kind.value}: " in err
    assert not (bench / "out").exists()


def test_the_option_knows_all_ways_to_merge():
    from tracking.composite import Merged

    assert {kind.value for kind in MergedAs} == {kind.value for kind in Merged}


def test_annotations_are_added_to_those_before(run, tmp_path):
    file = tmp_path / "said.toml"
    code, _, _ = run(
        "annotate", PHOTOS, "--out", file, "--photo", "simulated_01.jpg", "--corners",
        "1,2 3,2 3,8 1,8", "--plate", "150mmx140mm@40mm", "--flip", "simulated_02.jpg",
    )  # fmt: skip
    assert code == 0
    code, out, _ = run(
        "annotate", PHOTOS, "--out", file, "--click", "simulated_03.jpg:door=10,20", "--order",
        "simulated_05.jpg,simulated_04.jpg", "--delete", "simulated_06.jpg",
    )  # fmt: skip
    assert code == 0
    assert "robot marked in simulated_01.jpg, 1 points of the floor, 3 corrections" in out
    said = read_annotations(file)
    assert said.template is not None
    assert said.template.plate.width == 0.14
    assert len(said.corrections) == 3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--flip", "simulated_2.jpg"), "did you mean 'simulated_"),
        (("--photo", "simulated_01.jpg", "--corners", "1,2 3,4"), "2 corners; expected four"),
        (("--corners", "1,2 3,4 5,6 7,8"), "--photo: needed"),
        (("--click", "simulated_01.jpg:door=1"), "expected two pixels"),
        (("--click", "door=1,2"), "expected PHOTO:NAME=U,V"),
        (("--move", "simulated_01.jpg:1,2"), "expected PHOTO:X,Y,YAW"),
        (("--move", "simulated_01.jpg:a,b,c"), "no number"),
        (("--from", "nothing.toml"), "nothing.toml: no such file"),
    ],
)
def test_what_cannot_be_understood_is_one_line(options, message, run, tmp_path):
    file = tmp_path / "said.toml"
    code, _, err = run("annotate", PHOTOS, "--out", file, *options)
    assert code == 1
    assert message in err
    assert err.count("\n") == 1
    assert not file.exists()


def test_pixels_can_be_read_in_a_picture(run, tmp_path):
    file = tmp_path / "grid.png"
    code, _, _ = run(
        "annotate", PHOTOS, "--photo", "simulated_01.jpg", "--grid", file, "--around", "300,800"
    )
    assert code == 0
    assert cv2.imread(str(file)) is not None


def test_the_clock_on_the_terminal_can_be_read_by_a_camera():
    from tracking.images import read_clock

    cells = {" ": (255, 255), "█": (0, 0), "▀": (0, 255), "▄": (255, 0)}
    lines = re.sub(r"\x1b\[[\d;]*m", "", code_lines(1234567890.5)).splitlines()
    upper = np.array([[cells[c][0] for c in line] for line in lines])
    lower = np.array([[cells[c][1] for c in line] for line in lines])
    code = np.stack((upper, lower), axis=1).reshape(-1, upper.shape[1]).astype(np.uint8)
    assert read_clock(np.kron(code, np.ones((10, 10), np.uint8))) == 1234567890.5


def test_the_clock_runs_and_ends_by_itself(run):
    code, out, _ = run("camera", "clock", "--duration", "0.25")
    assert code == 0
    assert out.count("photograph this code") >= 2
