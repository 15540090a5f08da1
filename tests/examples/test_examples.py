# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))
SAYS = {
    "convert_slip.py": "so a mismatch is refused",
    "fit_arrays.py": "truth 1.564",
    "plot_slip_curve.py": "peaks at 4.842 N, slip ratio 0.0842",
}


def test_every_example_has_a_claim():
    assert {path.name for path in EXAMPLES} == set(SAYS)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example_fits_on_a_page(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) < 40


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example_runs_and_shows_what_it_promises(path, tmp_path):
    done = subprocess.run(
        [sys.executable, "-W", "error", path], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert SAYS[path.name] in done.stdout


def test_the_curve_is_a_picture_of_the_name_asked_for(tmp_path):
    picture = tmp_path / "curve.png"
    script = EXAMPLES[[path.name for path in EXAMPLES].index("plot_slip_curve.py")]
    subprocess.run([sys.executable, script, picture], check=True, capture_output=True)
    assert picture.read_bytes().startswith(b"\x89PNG")
