# SPDX-License-Identifier: MIT
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))
ONE_LOAD = Path(__file__).parents[2] / "datasets" / "rig-sim" / "simulated_load_02.13N.parquet"
ARGUMENTS = {"calibrate.py": [ONE_LOAD, "slip_curve.png", "500"]}
SAYS = {
    "calibrate.py": "wrote slip_curve.png",
    "track.py": "poses in",
    "twins.py": "legs: ",
    "validate.py": "prediction",
    "walk.py": "no-slip-simple",
}


def test_every_example_has_a_claim():
    assert {path.name for path in EXAMPLES} == set(SAYS)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_fits_on_a_page_and_imports_the_front_door_alone(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) < 40
    imported = set(re.findall(r"^(?:from|import) (\S+)", text, re.MULTILINE))
    assert "zebro_lab" in imported
    assert not {name for name in imported if name.split(".")[0] in ("model", "rig", "tracking")}
    assert not {name for name in imported if name.startswith("zebro_lab.")}
    assert "SIMULATED" in text


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_runs_and_shows_what_it_promises(path, tmp_path):
    done = subprocess.run(
        [sys.executable, "-W", "error", path, *ARGUMENTS.get(path.name, [])],
        cwd=tmp_path, env={**os.environ, "TMPDIR": str(tmp_path)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert SAYS[path.name] in done.stdout
