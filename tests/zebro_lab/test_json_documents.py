# SPDX-License-Identifier: MIT
"""`--json` of commands prints one document with the keys that docs/formats.md lists."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from support.bundled_walk import PHOTOS
from support.compared_folders import calibration
from support.experiment_plans import short_plan
from support.quick_fits import fit_quickly
from support.walk_requests import write_log
from support.written_runs import make_run

pytestmark = pytest.mark.usefixtures("blank_pictures")

FORMATS = Path(__file__).parents[2] / "docs/formats.md"


def documented(command):
    """Return what the row of a command in the table of docs/formats.md names."""
    table = FORMATS.read_text(encoding="utf-8").partition("\n## JSON documents of commands")[2]
    rows = [row.split("|", 2)[1:] for row in table.splitlines() if row.startswith("| ")]
    (keys,) = [keys for commands, keys in rows if f"`{command}`" in commands]
    return set(re.findall("`([^`]+)`", keys))


def document(ended, command, keys, *, code=0):
    """Return the document of a command that ended with a code, which must be all of its stdout."""
    assert ended.code == code, ended.err
    found = json.loads(ended.out)
    assert (found["command"], found["exit_code"]) == (command, code)
    assert set(found) - {"simulated"} == {"command", "exit_code"} | keys
    assert keys <= documented(command)
    return found


def test_predict_gives_the_walked_path_in_numbers(run_command, tmp_path):
    given = ("predict", write_log(tmp_path), "--model", "no-slip-simple", "--json", "--quiet")
    ended = run_command(*given, "--out", tmp_path / "out")
    assert ended.err == ""
    found = document(ended, "predict", {
        "folder", "title", "time_step_s", "duration_s", "end_x_m", "end_y_m", "end_yaw_rad",
        "length_m", "strides", "speed_m_per_s", "yaw_rate_rad_per_s", "radius_m",
        "largest_roll_rad", "largest_pitch_rad", "mean_slip_m_per_s", "notes",
        "schedule", "flight_share", "body_contact_share", "loaded_shares", "sliding_shares",
        "unloaded_shares", "segments", "contacts", "work_done_j", "work_taken_back_j",
        "slip_energy_j", "contact_energy_j",
    })  # fmt: skip
    assert found["length_m"] > 0
    assert found["folder"] == str(tmp_path / "out")


def test_a_fit_of_few_steps_has_its_verdict_and_exit_code_inside(
    run_command, sweep, tmp_path, monkeypatch
):
    fit_quickly(monkeypatch)
    monkeypatch.setattr("zebro_lab.calibration.stage.draw_calibration", lambda *_: None)
    ended = run_command(
        "calibrate-slip", sweep, "--out", tmp_path / "out", "--law", "coulomb-stribeck",
        "--max-steps", 1, "--threads", 1, "--json", "--quiet",
    )  # fmt: skip
    found = document(ended, "calibrate-slip", {"folder", "calibration"}, code=3)
    assert found["simulated"]
    slip = tomllib.loads((tmp_path / "out" / "slip.toml").read_text())
    assert found["calibration"].keys() == slip.keys()
    assert not found["calibration"]["verdict"]["converged"]


def test_a_run_is_listed_and_its_exclusion_is_told(run_command, tmp_path):
    run = make_run(tmp_path)
    ended = run_command("exclude", run, "--why", "belt slipped", "--json", "--quiet")
    found = document(ended, "exclude", {"folder", "excluded"})
    assert found["excluded"]["why"] == "belt slipped"
    found = document(run_command("runs", tmp_path, "--json"), "runs", {"runs"})
    (listed,) = found["runs"]
    assert listed.keys() == {"name", "state", "duration_s", "samples", "source"}
    assert listed["state"] == "excluded (belt slipped)"
    assert listed["duration_s"] > 0
    assert listed["samples"] == {"/board/raw": 200}
    ended = run_command("exclude", run, "--undo", "--json")
    assert document(ended, "exclude", {"folder", "excluded"})["excluded"] is None


def test_init_names_the_columns_that_it_guessed(run_command, tmp_path):
    table = tmp_path / "bench.csv"
    table.write_text("time [s],normal force [N],traction force [N],slip ratio\n0,4,1,0.1\n")
    ended = run_command("init", table, "--kind", "rig", "--json", "--quiet")
    keys = {"written", "kind", "columns", "to_check", "notes"}
    found = document(ended, "init", keys)
    assert found["columns"]["normal_force"] == "normal force [N]"
    assert found["written"] == [str(tmp_path / "columns.toml")]
    assert found["to_check"]


def test_a_plan_is_told_in_numbers(run_command, tmp_path):
    ended = run_command("rig", "plan", short_plan(tmp_path), "--json", "--quiet")
    keys = {"plan", "material", "profile", "points", "loads", "duration_s"}
    found = document(ended, "rig plan", keys)
    assert found["points"] == 2
    assert found["duration_s"] > 0


def test_rig_check_has_a_verdict_of_each_run_and_its_exit_code(run_command, tmp_path):
    curve = calibration(tmp_path / "curve")
    run = make_run(tmp_path / "data")
    ended = run_command("rig", "check", run, "--slip", curve, "--json")
    found = document(ended, "rig check", {"runs"}, code=ended.code)
    assert found["simulated"]
    (only,) = found["runs"]
    assert only.keys() == {
        "name", "slip_ratio", "normal_force_N", "traction_N", "expected_N", "sd_N", "verdict"
    }  # fmt: skip
    assert (only["verdict"] == "ok") == (ended.code == 0)


def test_annotations_are_counted(run_command, tmp_path):
    given = ("--click", "simulated_03.jpg:door=10,20", "--delete", "simulated_06.jpg")
    out = tmp_path / "said.toml"
    ended = run_command("annotate", PHOTOS, "--out", out, *given, "--json", "--quiet")
    found = document(ended, "annotate", {"written", "clicks", "corrections"})
    assert (found["written"], found["clicks"], found["corrections"]) == ([str(out)], 1, 1)


def test_a_recording_is_told_as_its_folder_tells_it(run_command, tmp_path):
    given = ("record", "--zebro", "sim", "--duration", 0.3, "--label", "x", "--data", tmp_path)
    ended = run_command(*given, "--json")
    found = document(ended, "record", {"folder", "run"})
    (folder,) = tmp_path.iterdir()
    assert found["simulated"]
    assert found["folder"] == str(folder)
    assert found["run"] == json.loads((folder / "run.json").read_text())
    assert found["run"]["streams"]["/legs/raw"] > 0
    assert "recording completed; run folder" in ended.err


def test_an_experiment_lists_its_runs_and_their_results(run_command, tmp_path):
    given = ("rig", "run", short_plan(tmp_path), "--rig", "sim", "--fast", "--seed", "2", "--data")
    ended = run_command(*given, tmp_path / "data", "--json")
    keys = {"folder", "source", "reason", "finished", "refused", "attempts", "latched", "runs"}
    found = document(ended, "rig run", keys)
    assert found["simulated"]
    assert (found["reason"], found["finished"], found["latched"]) == ("completed", 2, False)
    assert "point-0002" in ended.err
    assert len(found["runs"]) == 2
    for run in found["runs"]:
        assert (tmp_path / "data" / run["name"] / "run.json").is_file()
        assert run["accepted"]
        assert run["normal_force_N"] == pytest.approx(8, abs=1)
    again = run_command(*given, tmp_path / "data", "--resume", "--json", "--quiet")
    assert again.err == ""
    assert len(document(again, "rig run", keys)["runs"]) == 2


def test_a_weighing_is_told_in_numbers(run_command, tmp_path):
    given = ("rig", "weigh", "--rig", "sim", "--fast", "--masses", "0.2,1", "--data", tmp_path)
    found = document(run_command(*given, "--json", "--quiet"), "rig weigh", {
        "written", "weights", "slope", "slope_sd", "zero_N", "zero_sd_N", "largest_residual_N",
        "gain_sd", "bias_sd_N",
    })  # fmt: skip
    assert found["simulated"]
    assert [each["force_N"] for each in found["weights"]] == pytest.approx([0, 1.96133, 9.80665])
    load_cell = tomllib.loads((tmp_path / "columns.toml").read_text())["load_cell"]
    assert load_cell["gain_sd"] == pytest.approx(found["gain_sd"], rel=0.01)


def test_a_simulated_device_tells_its_port_while_it_is_served(run_command, monkeypatch, capsys):
    told = []
    monkeypatch.setattr(
        "zebro_lab.recording.simulate_command.wait_until",
        lambda *_, **__: told.append(capsys.readouterr().out),
    )
    assert run_command("sim", "zebro", "--json", "--quiet") == (0, "", "")
    found = json.loads(told[0])
    assert (found["command"], found["source"]) == ("sim zebro", "sim:zebro")
    assert found["address"] == f"zebro-100-serial@{found['ports']['robot']}"
