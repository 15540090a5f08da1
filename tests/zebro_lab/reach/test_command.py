# SPDX-License-Identifier: MIT
"""`reach` prints one document where that is asked for, and names what it lacks."""

import json

import pytest

SLIP = ("--slip", "thesis", "--dt", "0.005")
QUICK = ("--cycle", "0.5")


def test_json_has_the_ways_of_each_goal(run_command, tmp_path):
    ended = run_command(
        "reach", "--goal", "0.2,0.1", *SLIP, *QUICK, "--out", tmp_path / "out", "--json",
        "--quiet",
    )  # fmt: skip
    assert ended.err == ""
    found = json.loads(ended.out)
    (goal,) = found["goals"]
    assert (goal["x_m"], goal["y_m"], goal["heading_rad"]) == (0.2, 0.1, None)
    assert [way["manoeuvre"] for way in goal["ways"]] == ["stop-turn-walk", "curve"]
    assert goal["ways"][1]["heading_error_rad"] is None
    assert found["simulated"]
    assert (tmp_path / "out" / "curve.toml").exists()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--slip", "thesis"), "name a place"),
        (("--goal", "1,0"), "--slip"),
        (("--goal", "0.0001,0", "--slip", "thesis"), "is where the robot is"),
        (("--goal", "1,0", "--slip", "thesis", "--gait", "trot"), "known names"),
        (("--goal", "1,0", "--slip", "thesis", "--touchdown-deg", "120"), "touchdown"),
    ],
)  # fmt: skip
def test_mistakes_are_named(run_command, tmp_path, given, said):
    ended = run_command("reach", *given, "--out", tmp_path / "out")
    assert ended.code in (1, 2)
    assert said in ended.err
    assert not (tmp_path / "out").exists()
