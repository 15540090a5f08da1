# SPDX-License-Identifier: MIT
"""`zebro check` asks a person and writes a profile."""

import subprocess

from rig.zebro.profile import load_leg_profile
from support.commands import COMMAND


def test_zebro_check_fixes_order_and_writes_a_profile(tmp_path):
    file = tmp_path / "mine.toml"
    answers = ["1", "y", "2", "y", "9", "3", "n", "5", "y", "4", "y", "6", "y", ""]
    command = [COMMAND, "zebro", "check", "sim", "--save", file]
    checked = subprocess.run(
        command, input="\n".join(answers) + "\n", capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stderr
    assert f"wrote the profile {file}" in checked.stdout
    profile = load_leg_profile(str(file))
    assert profile.legs == (1, 2, 3, 5, 4, 6)
    assert profile.sign == (1, 1, -1, 1, 1, 1)
    again = subprocess.run(command, input="", capture_output=True, text=True, check=False)
    assert (again.returncode, again.stderr.count("\n")) == (1, 1)
