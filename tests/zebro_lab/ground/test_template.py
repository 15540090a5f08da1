# SPDX-License-Identifier: MIT
"""`zebro-lab init ground.toml --kind ground`, from the command to a walk."""

import re

import numpy as np
import pytest

from model.walk.ground import is_level
from zebro_lab.exchange.init_stage import write_template
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.ground.ground_file import read_ground
from zebro_lab.ground.template import TEMPLATE
from zebro_lab.robot.robot_file import RobotFile, read_robot_file


def test_walk_takes_a_written_ground_as_it_is(run_command, tmp_path):
    file = tmp_path / "ground.toml"
    ended = run_command("init", file, "--kind", "ground")
    assert ended.code == 0, ended.err
    assert f"walk --ground {file}" in " ".join(ended.out.split())
    assert is_level(read_ground(file).ground)
    words = ("walk", "--slip", "coulomb:0.4", "--duration", 0.5, "--ground", file)
    assert run_command(*words, "--out", tmp_path / "w").code == 0


def test_every_example_in_its_comments_can_be_taken(tmp_path):
    np.savetxt(tmp_path / "h.csv", np.zeros((5, 5)), delimiter=",")
    text = TEMPLATE.format(name="ground.toml")
    lines = text.splitlines()
    examples = [line[2:] for line in lines if re.match(r"# (\w+ = |\[\[)", line)]
    keys = {line.split(" =")[0] for line in examples}
    assert keys == {"heights"}
    file = tmp_path / "ground.toml"
    file.write_text("\n".join(examples))
    assert len(read_ground(file).what) == 1


@pytest.mark.parametrize("key", ["slope_deg", "heights", "file", "step", "origin", "unit"])
def test_every_key_is_there(key):
    assert key in TEMPLATE


def test_an_existing_file_is_kept_unless_it_is_forced(run_command, tmp_path):
    file = tmp_path / "ground.toml"
    file.write_text("slope_deg = [1.0, 0.0]\n")
    ended = run_command("init", file, "--kind", "ground")
    assert ended.code == 1
    assert "exists already; edit it, replace it with --force" in " ".join(ended.err.split())
    assert file.read_text() == "slope_deg = [1.0, 0.0]\n"
    assert run_command("init", file, "--kind", "ground", "--force").code == 0
    assert "heights" in file.read_text()


def test_a_folder_is_no_file_to_write(tmp_path):
    with pytest.raises(AlreadyExists, match="is a folder; name the file to write"):
        write_template(tmp_path, "ground")


def test_a_sheet_of_a_ground_is_refused(run_command, tmp_path):
    ended = run_command("init", tmp_path / "g.toml", "--kind", "ground", "--sheet", "a")
    assert ended.code == 2
    assert "a ground has none" in ended.err


def test_a_written_robot_is_the_thesis_s_robot(run_command, tmp_path):
    file = tmp_path / "robot.toml"
    ended = run_command("init", file, "--kind", "robot")
    assert ended.code == 0, ended.err
    assert f"walk --robot {file}" in " ".join(ended.out.split())
    assert read_robot_file(file).robot.mass == RobotFile().robot.mass
