# SPDX-License-Identifier: MIT
"""`zebro-lab track` as its user meets it."""

from pathlib import Path

import pytest

from support.bundled_walk import PHOTOS, WALK

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_preview_in_a_pipe_says_what_is_seen_and_draws_it(run_command, files):
    code, out, err = run_command(
        "track", PHOTOS, "--camera", files / "camera.toml", "--floor", files / "floor.toml",
        "--robot", WALK / "robot.toml", "--preview", files / "preview.png",
    )  # fmt: skip
    assert (code, err) == (0, "")
    for part in ("marks 10, 11, 12, 13 are seen", "a pixel is ", "10 to 11: tape measure 1.7000 m"):
        assert part in out
    assert (files / "preview.png").is_file()


def test_a_wrong_tape_is_pointed_at(run_command, files, undrawn):
    floor = files / "floor.toml"
    floor.write_text(floor.read_text().replace("x = 2.2", "x = 2.215"))
    code, out, err = run_command(
        "track", PHOTOS, "--camera", files / "camera.toml", "--floor", floor,
        "--robot", WALK / "robot.toml", "--preview", files / "preview.png",
    )  # fmt: skip
    assert code == 0
    assert "<-- off" in out
    assert "measure the floor again" in err


ERRORS = {
    "no such photographs": (("nowhere",), "nowhere: no such folder, video or picture"),
    "no camera": ((PHOTOS, "--camera", "none.toml"), "none.toml: no such file"),
    "no robot's height": ((PHOTOS, "--robot", "robot.toml"), "marker.height: missing"),
    "two sources of time": ((PHOTOS, "--interval", "2", "--times", "t.csv"), "--times: not toge"),
    "no unit": ((PHOTOS, "--body-height", "6 kg"), "unit 'kg'"),
    "exact height": ((PHOTOS, "--mean-height-sd", "0"), "--mean-height-sd: is 0 m; expected more"),
    "no such clock": ((PHOTOS, "--clock", "clock.jpg"), "clock.jpg: no such file"),
    "no annotations": ((PHOTOS, "--without-marker"), "annotate PHOTOS"),
}  # fmt: skip


@pytest.mark.parametrize(("arguments", "message"), ERRORS.values(), ids=ERRORS)
def test_an_error_is_one_line_and_nothing_is_written(
    arguments, message, run_command, files, monkeypatch
):
    monkeypatch.chdir(files)
    Path("robot.toml").write_text("[marker]\nposition = [0, 0, 0.0385]\n")
    robot = () if "--robot" in arguments else ("--robot", WALK / "robot.toml")
    camera = () if "--camera" in arguments else ("--camera", "camera.toml")
    given = ("track", *arguments, *robot, *camera, "--floor", "floor.toml", "--out", "out")
    code, out, err = run_command(*given)
    of_an_option = err.startswith("error: --")
    assert (code, out) == (2 if of_an_option else 1, "")
    assert err.startswith("error: ")
    assert message in err
    assert err.count("\n") == 1
    assert not Path("out").exists()


def test_nowhere_to_write_and_nothing_to_say_are_wrong_usage(run_command, files):
    code, _, err = run_command("track", PHOTOS, "--camera", files / "camera.toml", "--floor",
                       files / "floor.toml")  # fmt: skip
    assert code == 2
    assert "--out FOLDER" in err
    code, _, err = run_command("annotate", PHOTOS, "--out", files / "said.toml")
    assert code == 2
    assert "no annotation is given" in err
