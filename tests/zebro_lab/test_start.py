# SPDX-License-Identifier: MIT
"""A file of the user's that is named like a package of ours is named in one sentence."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(sys.executable).parent


@pytest.mark.parametrize(
    ("name", "package"),
    [("model.py", "model"), ("rig", "rig"), ("tracking/__init__.py", "tracking")],
)
def test_a_shadowed_package_is_one_line_of_a_command(name, package, tmp_path):
    foreign = tmp_path / name
    if foreign.suffix:
        foreign.parent.mkdir(exist_ok=True)
        foreign.write_text("")
    else:
        foreign.mkdir()
        (foreign / "__init__.py").write_text("")
    done = subprocess.run(
        [SCRIPTS / "zebro-lab", "walk", "--help"], env={"PYTHONPATH": str(tmp_path)},
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert str(tmp_path) in line
    assert f"instead of the package '{package}'" in line


def test_a_notebook_beside_a_foreign_model_is_told(tmp_path):
    (tmp_path / "model.py").write_text("")
    done = subprocess.run(
        [sys.executable, "-c", "import zebro_lab as zl; zl.read_slip_curve('x')"],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    last = done.stderr.splitlines()[-1]
    assert last.startswith(f"ImportError: Python imports {tmp_path / 'model.py'} instead")
