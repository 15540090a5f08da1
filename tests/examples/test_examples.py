# SPDX-License-Identifier: MIT
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from support.quick_fits import fit_quickly

CHECKOUT = Path(__file__).parents[2]
EXAMPLES = sorted((CHECKOUT / "examples").glob("*.py"))
ONE_LOAD = "simulated_load_02.13N.csv.gz"
ARGUMENTS = {"calibrate.py": [ONE_LOAD, "slip_curve.png", "100"]}
EVERY_RUN = 5
"""Of a load's runs every how many are in the tests' smaller dataset."""
PHOTOS = ("simulated_00.jpg", "simulated_02.jpg", "simulated_04.jpg")
WALKED = 9.0
"""Duration of the tests' shorter leg log [s]; the last of the photographs is at 8 s."""
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


@pytest.fixture
def smaller(tmp_path, monkeypatch):
    """Return a checkout of the examples with a part of the data, and work in its folder."""
    shutil.copytree(CHECKOUT / "examples", tmp_path / "examples")
    walk = tmp_path / "datasets" / "walk-sim"
    shutil.copytree(
        CHECKOUT / "datasets" / "walk-sim", walk, ignore=shutil.ignore_patterns("composite")
    )
    for photo in (walk / "photos").glob("*.jpg"):
        if photo.name not in PHOTOS:
            photo.unlink()
    legs = pd.read_csv(walk / "legs.csv")
    legs[legs.t < WALKED].to_csv(walk / "legs.csv", index=False)
    rig = CHECKOUT / "datasets" / "rig-sim"
    table = pd.read_csv(rig / ONE_LOAD)
    table[table.run.isin(table.run.unique()[::EVERY_RUN])].to_csv(tmp_path / ONE_LOAD, index=False)
    shutil.copy(rig / "columns.toml", tmp_path)
    fit_quickly(monkeypatch)
    # The floor as pictures show it, which stay blank.
    monkeypatch.setattr(
        "zebro_lab.track.photographs.PlacedPhoto.from_above",
        lambda *_, **__: np.zeros((2, 2, 3), np.uint8),
    )
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.parametrize(
    "path", [path for path in EXAMPLES if path.name != "twins.py"], ids=lambda path: path.name
)
def test_an_example_runs_and_shows_what_it_promises(path, smaller, monkeypatch, capsys):
    monkeypatch.setattr(tempfile, "tempdir", str(smaller))
    monkeypatch.setattr(sys, "argv", [path.name, *ARGUMENTS.get(path.name, [])])
    runpy.run_path(str(smaller / "examples" / path.name), run_name="__main__")
    assert SAYS[path.name] in capsys.readouterr().out


def test_an_example_is_a_program_of_its_own(tmp_path):
    done = subprocess.run(
        [sys.executable, "-W", "error", CHECKOUT / "examples" / "twins.py"],
        cwd=tmp_path, env={**os.environ, "TMPDIR": str(tmp_path)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert SAYS["twins.py"] in done.stdout
