# SPDX-License-Identifier: MIT
"""Runs lines in clean folders, a folder a page, and keeps what each printed and wrote."""

import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path

from benchmarks.documented_commands.lines import Line

RECORDS = "lines.json"
FIRST_OUTPUT = 30.0
"""Longest wait for the first line of a command that serves [s]."""
STOPPING = 20.0
"""Longest wait for its end after Ctrl-C [s]."""


@dataclass(frozen=True)
class Outcome:
    """What came of a line.

    Attributes:
        line: The line.
        code: Exit code; None where it was left out, serves, or took too long.
        stdout: What it printed.
        stderr: What it complained of.
        files: Files that it made or changed, from the page's folder.
    """

    line: Line
    code: int | None = None
    stdout: str = ""
    stderr: str = ""
    files: tuple[str, ...] = ()


def read_outcomes(out: Path) -> list[Outcome]:
    """Read what `run_lines` wrote."""
    rows = json.loads((out / RECORDS).read_text(encoding="utf-8"))
    return [
        Outcome(**(row | {"line": Line(**row["line"]), "files": tuple(row["files"])}))
        for row in rows
    ]


def kept(out: Path, number: int) -> Path:
    """Return the folder that keeps the files of a line, by its number among all."""
    return out / "kept" / f"{number:03d}"


def run_lines(
    lines: Sequence[Line], out: Path, *, inputs: Path, programs: Path, limit: float
) -> list[Outcome]:
    """Run lines in order and keep what came of them.

    Args:
        lines: The lines, those of a page one after the other.
        out: Folder to make.
        inputs: Checkout whose `datasets` and `examples` the pages find beside them.
        programs: Folder with `zebro-lab`, `calibrate-slip` and `python`.
        limit: Longest run of a line [s].
    """
    out.mkdir(parents=True)
    outcomes: list[Outcome] = []
    for page, of_page in groupby(lines, key=lambda line: line.page):
        work = out / "work" / page.replace("/", "_")
        work.mkdir(parents=True)
        for name in ("datasets", "examples"):
            if (inputs / name).is_dir():
                (work / name).symlink_to((inputs / name).resolve())
        with ExitStack() as until_the_page_ends:
            for line in of_page:
                said = [out / f"{len(outcomes):03d}.{kind}" for kind in ("out", "err")]
                outcome = run_line(line, work, said, programs, limit, until_the_page_ends)
                for name in outcome.files:
                    target = kept(out, len(outcomes)) / name
                    target.parent.mkdir(parents=True, exist_ok=True)
                    with suppress(FileNotFoundError):
                        shutil.copy2(work / name, target)
                outcomes.append(outcome)
                print(f"{outcome.code!s:>5}  {page}: {line.text}", flush=True)
    rows = [asdict(outcome) for outcome in outcomes]
    (out / RECORDS).write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return outcomes


def run_line(
    line: Line, work: Path, said: Sequence[Path], programs: Path, limit: float, page: ExitStack
) -> Outcome:
    """Run a line in a folder; start it until the page ends where it serves."""
    if not line.command:
        return Outcome(line)
    before, code = _tree(work), None
    running = started(line.command, work, said, programs)
    if line.serves:
        process = page.enter_context(running)
        end = time.monotonic() + FIRST_OUTPUT
        while not said[0].stat().st_size and process.poll() is None and time.monotonic() < end:
            time.sleep(0.05)
        code = process.poll()
    else:
        with running as process, suppress(subprocess.TimeoutExpired):
            code = process.wait(limit)
    stdout, stderr = (file.read_text(encoding="utf-8", errors="replace") for file in said)
    made = sorted(name for name, changed in _tree(work).items() if before.get(name) != changed)
    return Outcome(line, code, stdout, stderr, tuple(made))


@contextmanager
def started(
    command: str, work: Path, said: Sequence[Path], programs: Path
) -> Iterator[subprocess.Popen[bytes]]:
    """Start a command in an environment of its own; stop it, and what it left running, at last."""
    environment = {
        "PATH": f"{programs}:/usr/bin:/bin", "HOME": str(work.parent), "LANG": "C.UTF-8",
        "COLUMNS": "120", "MPLBACKEND": "Agg", "TZ": "UTC",
    }  # fmt: skip
    with said[0].open("wb") as out, said[1].open("wb") as err:
        process = subprocess.Popen(
            ["bash", "-c", command], cwd=work, env=environment, stdin=subprocess.DEVNULL,
            stdout=out, stderr=err, start_new_session=True,
        )  # fmt: skip
    try:
        yield process
    finally:
        for number in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError, subprocess.TimeoutExpired):
                os.killpg(process.pid, number)
                process.wait(STOPPING)
                break
        process.wait()


def _tree(folder: Path) -> dict[str, int]:
    """Return when every file in a folder was changed [ns]."""
    files = (file for file in folder.rglob("*") if file.is_file() and not file.is_symlink())
    return {str(file.relative_to(folder)): file.stat().st_mtime_ns for file in files}
