# SPDX-License-Identifier: MIT
"""The shell lines of README.md, docs/*.md and the Makefile's demonstration, with what is done.

A fence marked as a shell's holds commands; one without a language holds those of its lines that
begin with a command of ours. A table says which lines are left out and why, which run with another
device than the one they name, and which go on until they are stopped.
"""

import re
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

SHELLS = {"sh", "bash", "shell", "console"}
OURS = re.compile(r"(\.venv/bin/)?(zebro-lab|calibrate-slip|python|make)\b|\$EDITOR\b")
FENCE = re.compile(r"^```([\w-]*)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
COMMENT = re.compile(r"(?<=\S)\s{2,}#.*$")

LEFT_OUT = (
    (r"^make ", "installs, or runs tests; the lines of make demo are run one by one"),
    (r"pytest|benchmarks\.|docs/\S+\.py", "a long test or a measurement of time"),
    (r"rig say ", "needs an experiment that is under way"),
    (r"rig weigh ", "asks a person to hang up masses"),
    (r"CALIBRATION|PROFILE@|<\w+>|…", "has a placeholder"),
)
INSTEAD = (
    (r"^\$EDITOR (\S+)", r"cp datasets/rig-sim/columns.toml \1", "a person edits"),
    (r"(rig run .*)--rig \S+@\S+", r"\1--rig sim --fast", "no rig at hand"),
    (r"(record .*)--(zebro|imu|rig) \S+@\S+", r"\1--\2 sim --duration 3", "no device at hand"),
    (r"--(zebro|imu|rig) \S+@(?:/dev|socketcan)\S+", r"--\1 sim", "no device at hand"),
)
SERVES = re.compile(r"^zebro-lab sim ")
REAL_TIME = re.compile(r"^zebro-lab (record|sim|doctor|runs)\b")
"""Commands whose numbers depend on when they run, or on runs recorded in real time."""


@dataclass(frozen=True)
class Line:
    """A line of the documentation.

    Attributes:
        page: Where it stands, such as `docs/recording.md`.
        text: The line as it stands there.
        command: What is run; empty where it is left out.
        note: Why it is left out, or replaced.
        serves: Whether it goes on until it is stopped.
        real_time: Whether its numbers depend on when it runs, so that exit codes and names of files
            alone can be compared.
    """

    page: str
    text: str
    command: str
    note: str = ""
    serves: bool = False
    real_time: bool = False


def find_lines(checkout: Path) -> list[Line]:
    """Find the lines of every page in order, each page's preparation first."""
    pages = [checkout / "README.md", *sorted((checkout / "docs").glob("*.md"))]
    texts = {
        str(page.relative_to(checkout)): shell_lines(page.read_text(encoding="utf-8"))
        for page in pages
    }
    texts["Makefile"] = demo_lines(checkout)
    found = []
    for page, lines in texts.items():
        read = [read_line(page, line) for line in lines]
        if any(each.command for each in read):
            prepared = (Line(page, p, p) for p in PREPARED.get(page, ()))
            found += [*prepared, *read]
    return found


def shell_lines(text: str) -> list[str]:
    """Return the commands in a page's fences, comments cut off and continued lines joined."""
    found = []
    for language, body in FENCE.findall(text):
        if language and language not in SHELLS:
            continue
        for raw in re.sub(r"\\\n\s*", "", body).splitlines():
            line = COMMENT.sub("", raw.strip())
            if language == "console":
                line = line.removeprefix("$ ") if line.startswith("$ ") else ""
            if line and not line.startswith("#") and (language or OURS.match(line)):
                found.append(line)
    return found


def demo_lines(checkout: Path) -> list[str]:
    """Return what `make demo` would run, installing left out."""
    command = ["make", "-n", "--no-print-directory", "-o", ".venv/.installed", "demo"]
    done = subprocess.run(command, cwd=checkout, capture_output=True, text=True)
    joined = re.sub(r"\\\n\s*", "", done.stdout)
    return [line for line in joined.splitlines() if not line.startswith("echo ")]


def read_line(page: str, text: str) -> Line:
    """Decide what is done with a line."""
    command = text.replace(".venv/bin/", "")
    line = Line(page, text, command, serves=bool(SERVES.match(command)))
    line = replace(line, real_time=bool(REAL_TIME.match(command)))
    for pattern, why in LEFT_OUT:
        if re.search(pattern, command):
            return replace(line, command="", note=why)
    for pattern, instead, why in INSTEAD:
        if re.search(pattern, command):
            command = re.sub(pattern, instead, command)
            line = replace(line, command=command, note=f"{why}: {command}")
    return line


_WALK = "datasets/walk-sim"
_RIG_TABLE = (
    "mkdir -p data && python -c \"import pandas as pd; from pathlib import Path; pd.concat("
    "[pd.read_csv(f) for f in sorted(Path('datasets/rig-sim').glob('*.csv.gz'))])"
    ".to_csv('{}', index=False)\""
)  # fmt: skip
_SEEN = (
    "python -c \"import numpy as np, pandas as pd; p = pd.read_csv('datasets/walk-sim/truth.csv')"
    '[::200]; z = 0 * p.t; {}"'
)
_TUM = _SEEN.format(
    "np.savetxt('path.tum', np.column_stack([p.t, p.x, p.y, p.z, z, z, np.sin(p.yaw / 2), "
    "np.cos(p.yaw / 2)]))"
)
_TRACK = _SEEN.format(
    "pd.DataFrame(dict(t_s=p.t, x_m=p.x, y_m=p.y, yaw_rad=p.yaw)).to_csv('track.csv', index=False)"
)
_START = "--start 2026-03-04T05:06:07+00:00"
_TAKEN = "--start 2020-06-01T12:00:00+00:00"  # when the bundled photographs were taken
_LOGS = f"cp {_WALK}/legs.csv {_WALK}/imu.csv {_WALK}/robot.toml ."
PREPARED = {
    "README.md": (_RIG_TABLE.format("data/bench.csv"), _LOGS, _TUM),
    "docs/calibration.md": (_RIG_TABLE.format("data/bench.csv"),),
    "docs/experiments.md": (
        "mkdir fresh && cp datasets/rig-sim/*.csv.gz datasets/rig-sim/columns.toml fresh",
    ),
    "docs/recording.md": (
        _LOGS, _TUM, _RIG_TABLE.format("sweep.csv"),
        "sed 's/^\\[/[rig./' datasets/rig-sim/columns.toml > columns.toml",
        "zebro-lab walk --gait tripod --steering 1.3 --slip coulomb:0.4 --duration 10 --out walk",
        f"zebro-lab import --legs legs.csv --robot robot.toml --label circle {_START} --data data",
    ),
    "docs/validation.md": (
        _LOGS, _TRACK, "calibrate-slip datasets/rig-sim --out calibration",
        "cp -r calibration calibration-tiles && cp -r calibration calibration-carpet",
        f"zebro-lab import --legs legs.csv --imu imu.csv --robot robot.toml {_TAKEN} --data new",
        "mkdir data && mv new/* data/RUN && cp datasets/rig-sim/*.csv.gz "
        "datasets/rig-sim/columns.toml data",
        f"zebro-lab track {_WALK}/photos --camera {_WALK}/camera.toml --floor {_WALK}/floor.toml "
        f"--robot robot.toml {_TAKEN} --run data/RUN",
        "cp -r data/RUN data/RUN1 && cp -r data/RUN data/RUN2",
        "zebro-lab predict legs.csv --slip calibration --draws 100 --out prediction",
    ),
}  # fmt: skip
"""What the lines of a page need: their data, made of the bundled ones."""
