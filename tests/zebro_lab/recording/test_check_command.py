# SPDX-License-Identifier: MIT
"""`zebro check` asks a person and writes a profile."""

import io
import json
import os

from rig.zebro.profile import load_leg_profile


def test_zebro_check_fixes_order_and_writes_a_profile(run_command, monkeypatch, tmp_path):
    file = tmp_path / "mine.toml"
    answers = ["1", "y", "2", "y", "9", "3", "n", "5", "y", "4", "y", "6", "y", "", ""]
    monkeypatch.setattr("sys.stdin", io.StringIO("\n".join(answers)))
    for wait in ("DURATION", "SETTLING"):
        monkeypatch.setattr(f"rig.zebro.check.{wait}", 0.25)
    code, out, err = run_command("zebro", "check", "sim", "--save", file, "--json")
    assert code == 0, err
    assert "channel 1 was moved; which leg turned" in err
    assert "found '9'; expected 1 to 6" in err
    assert f"wrote the profile {file}" in err
    profile = load_leg_profile(str(file))
    assert profile.legs == (1, 2, 3, 5, 4, 6)
    assert profile.sign == (1, 1, -1, 1, 1, 1)
    assert json.loads(out) == {
        "command": "zebro check", "exit_code": 0, "simulated": True, "written": [str(file)],
        "legs": list(profile.legs), "signs": list(profile.sign),
        "zero_counts": list(profile.zero_counts),
        "counts_per_revolution": profile.counts_per_revolution, "lift_off": None,
    }  # fmt: skip
    code, out, err = run_command("zebro", "check", "sim", "--save", file)
    assert (code, out, err.count("\n")) == (1, "", 1)


def test_a_question_that_is_not_answered_is_one_line_and_nothing_is_written(
    run_command, monkeypatch, tmp_path
):
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    code, out, err = run_command("zebro", "check", "sim", "--save", tmp_path / "mine.toml")
    assert (code, out) == (1, "")
    question, error = err.splitlines()
    assert "which leg turned" in question
    assert error.startswith("error: standard input has ended")
    assert not list(tmp_path.iterdir())


def test_nothing_moves_where_nobody_can_answer(run_command, monkeypatch, tmp_path):
    moved = []
    monkeypatch.setattr("zebro_lab.recording.check_stage.check_zebro", lambda *_: moved.append(1))
    with open(os.devnull) as nobody:  # noqa: PTH123 - standard input as a shell redirects it
        monkeypatch.setattr("sys.stdin", nobody)
        code, out, err = run_command("zebro", "check", "sim", "--save", tmp_path / "mine.toml")
    assert (code, out, moved) == (1, "", [])
    assert err.startswith("error: standard input has ended")
    assert err.count("\n") == 1
