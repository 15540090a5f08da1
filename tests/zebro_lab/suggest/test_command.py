# SPDX-License-Identifier: MIT
"""`rig suggest` on a small calibration: each kind of target, the plan it writes, its messages."""

import csv
import json
import tomllib

import pytest

from support.short_calibration import calibration_folder
from support.suggestions import write_plan
from support.walk_requests import write_log
from zebro_lab.experiment.plan_stage import read_plan

pytestmark = pytest.mark.usefixtures("blank_pictures")


@pytest.fixture(scope="module")
def calibration(tmp_path_factory):
    """Return the folder of a calibration at loads of 4 and 12 N, slips up to 0.3."""
    return calibration_folder(tmp_path_factory.mktemp("made") / "mine")


@pytest.fixture
def suggest(run_command, calibration, tmp_path, monkeypatch):
    """Return what suggests points for a plan beside the calibration."""
    monkeypatch.chdir(tmp_path)

    def suggested(*arguments, plan=None, of=calibration):
        file = write_plan(tmp_path) if plan is None else plan
        return run_command(
            "rig", "suggest", file, "--calibration", of, "--rate", "40", *arguments
        )  # fmt: skip

    return suggested


def rows(folder):
    with (folder / "expected.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_parameter_force_and_walk_are_targets_of_a_plan_that_rig_plan_takes(
    suggest, run_command, tmp_path
):
    write_log(tmp_path)
    ended = suggest(
        "--target", "slip_stiffness", "--target", "force@0.02,0.2:8", "--target", "walk:legs.csv",
        "--time", "120", "--json",
    )  # fmt: skip
    assert ended.code == 0, ended.err
    document = json.loads(ended.out)
    assert document.keys() == {
        "command", "exit_code", "folder", "simulated", "notes", "loads_N", "slips", "point_s",
        "duration_s", "plan_duration_s", "expected",
    }  # fmt: skip
    assert (document["command"], document["simulated"]) == ("rig suggest", True)
    folder = tmp_path / "plan-suggested"
    assert {p.name for p in folder.iterdir()} == {
        "plan.toml", "expected.csv", "suggested.png", "manifest.json"
    }  # fmt: skip
    parts = [row["part"] for row in rows(folder)]
    assert parts == ["slip_stiffness", "force@0.02:8", "force@0.2:8", "x", "y", "heading"]
    for row in rows(folder):
        assert 0 < float(row["sd_suggested"]) < float(row["sd_now"])
    plan = read_plan(folder / "plan.toml")
    total = sum(each["points"] for each in document["slips"])
    assert (len(plan.points.slips), plan.points.duration) == (total, document["point_s"])
    assert list(plan.points.loads) == document["loads_N"]
    assert run_command("rig", "plan", folder / "plan.toml").code == 0
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["settings"]["targets"][2] == "walk:legs.csv"
    assert {"legs.csv", str(tmp_path / "plan.toml")} <= set(manifest["inputs"])
    assert manifest["source"] == "sim:test"


def test_a_suggestion_of_the_same_time_beats_the_plan_and_the_seed_decides_it(suggest, tmp_path):
    for out in ("one", "two"):
        ended = suggest("--target", "slip_stiffness", "--seed", "3", "--out", out)
        assert ended.code == 0, ended.err
    assert "after the plan" in ended.out
    (row,) = rows(tmp_path / "one")
    assert float(row["sd_suggested"]) < float(row["sd_plan"]) < float(row["sd_now"])
    assert (tmp_path / "one" / "plan.toml").read_text() == (
        tmp_path / "two" / "plan.toml"
    ).read_text()


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("slip_stifness", "did you mean 'slip_stiffness'?"),
        (
            "crosstalk",
            "is no parameter of the law 'magic-formula', which has slip_stiffness, shape",
        ),
        ("walk:nowhere", "nowhere"),
        ("walk:.", "is a folder without path.csv"),
    ],
)
def test_a_target_that_is_unknown_says_what_there_is(suggest, tmp_path, target, said):
    ended = suggest("--target", target)
    assert ended.code in (1, 2)
    assert said in ended.err
    assert not (tmp_path / "plan-suggested").exists()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("# sweep = true", "sweep = true", "points.sweep: glides through its slip ratios"),
        ("{ first = 0.0, last = 0.3, count = 12 }", "[0.1]", "points.slips: has one slip ratio"),
        ("normal_force = 25.0", "normal_force = 9.0", "limits.normal_force"),
    ],
)
def test_a_plan_without_points_to_choose_from_is_refused(suggest, tmp_path, old, new, said):
    ended = suggest("--target", "friction", plan=write_plan(tmp_path, (old, new)))
    assert ended.code in (1, 2)
    assert said in " ".join(ended.err.split()) or "normal force" in ended.err


def broken(folder, file, old, new):
    """Write a calibration of which a file says something else."""
    made = calibration_folder(folder / "broken")
    text = (made / file).read_text()
    assert old in text
    (made / file).write_text(text.replace(old, new))
    return made


def test_a_calibration_of_other_slip_is_refused(suggest, tmp_path):
    made = broken(tmp_path, "slip.toml", '"material"', '"travel"')
    ended = suggest("--target", "friction", of=made)
    assert ended.code in (1, 2)
    assert "is of 'travel' slip; plans are in 'material' slip" in ended.err


def test_a_calibration_of_another_law_or_version_is_refused(suggest, tmp_path):
    made = broken(tmp_path, "slip.toml", 'name = "magic-formula"', 'name = "brush"')
    ended = suggest("--target", "friction", of=made)
    assert ended.code == 1
    assert "slip.toml" in ended.err or "posterior.nc" in ended.err
    (made / "posterior.nc").unlink()
    assert suggest("--target", "friction", of=made).code == 1


def test_a_folder_of_others_is_not_replaced(suggest, tmp_path):
    (tmp_path / "plan-suggested").mkdir()
    (tmp_path / "plan-suggested" / "plan.toml").write_text("mine")
    ended = suggest("--target", "friction")
    assert ended.code == 1
    assert "exists and is not replaced" in ended.err
    assert (tmp_path / "plan-suggested" / "plan.toml").read_text() == "mine"


def test_the_plan_may_not_be_replaced_by_the_result(suggest, tmp_path):
    (tmp_path / "plan-suggested").mkdir()
    plan = write_plan(tmp_path / "plan-suggested")
    ended = suggest("--target", "friction", plan=plan)
    assert ended.code == 1
    assert tomllib.loads(plan.read_text())["name"] == "thesis 4 x 62"
