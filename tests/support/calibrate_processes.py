# SPDX-License-Identifier: MIT
"""`calibrate-slip` as a process of its own, with a few of its constants changed where asked for."""

import subprocess
import sys
from pathlib import Path

COMMAND = str(Path(sys.executable).with_name("calibrate-slip"))
SMALL_FIT = ("--threads", "1")
SMALLER_FIT = ("--law", "brush", "--threads", "1")
"""A fit of a law with two parameters, for claims that hold for all laws."""
PICTURES = {f"{name}.png" for name in ("curves", "surface", "corner", "traces", "residuals")}
FILES = {"slip.toml", "summary.csv", "posterior.nc", "manifest.json"} | PICTURES
EARLY = {"FIRST_LOOK": 40, "IMPORTANCE_DRAWS": 1000, "EFFECTIVE_DRAWS": 100.0}
"""Constants of `model.bayes.calibrate` by which a fit ends after 40 moves, of few draws."""
JUDGED_EARLY = (
    "import model.bayes.approximation as starts; starts.FEW_BLOCKS = 0; "
    "import model.bayes.calibrate as fits; "
    + "".join(f"fits.{name} = {value}; " for name, value in EARLY.items())
)
MAIN = "from zebro_lab.main import calibrate_slip; calibrate_slip()"


def run(command: list[str]) -> subprocess.CompletedProcess[str]:
    """Run a command to its end, and keep what it printed."""
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=500)


def calibrate_slip(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run the installed command."""
    return run([COMMAND, *map(str, arguments)])


def patched(patch: str, *arguments: object) -> list[str]:
    """Return the command with a few of its constants changed."""
    return [sys.executable, "-c", patch + MAIN, *map(str, arguments)]


def names(folder: Path) -> set[str]:
    """Return the names of what is in a folder."""
    return {path.name for path in folder.iterdir()}
