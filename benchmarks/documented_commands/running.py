# SPDX-License-Identifier: MIT
"""Runs lines in clean folders, a folder a page, and keeps what each printed and wrote."""

import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass, field
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
        code: Exit code; None where it was left out or took too long.
        stdout: What it printed.
        stderr: What it complained of.
        seconds: How long it took.
        over_limit: Whether it was ended because it took too long.
        files: Files that it made or changed, from the page's folder.
        removed: Files that it removed.
    """

    line: Line
    code: int | None = None
    stdout: str = ""
    stderr: str = ""
    seconds: float = 0.0
    over_limit: bool = False
    files: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()


def read_outcomes(out: Path) -> list[Outcome]:
    """Read what `run_lines` wrote."""
    rows = json.loads((out / RECORDS).read_text(encoding="utf-8"))
    return [
        Outcome(**(row | {"line": Line(**row["line"]), "files": tuple(row["files"]),
                          "removed": tuple(row["removed"])}))
        for row in rows
    ]  # fmt: skip


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
        with ExitStack() as stack:
            runner = Runner(work, programs=programs, limit=limit, stack=stack)
            for line in of_page:
                outcome = runner.run(line)
                for name in outcome.files:
                    target = kept(out, len(outcomes)) / name
                    target.parent.mkdir(parents=True, exist_ok=True)
                    with suppress(FileNotFoundError):
                        shutil.copy2(work / name, target)
                outcomes.append(outcome)
                print(f"{outcome.code!s:>5} {outcome.seconds:6.1f} s  {page}: {line.text}",
                      flush=True)  # fmt: skip
        rows = [asdict(outcome) for outcome in outcomes]
        (out / RECORDS).write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return outcomes


@dataclass
class Runner:
    """Runs the lines of one page.

    Attributes:
        work: The page's folder.
        programs: Folder of the environment's programs.
        limit: Longest run of a line [s].
        stack: Ends, with the page, what serves.
    """

    work: Path
    programs: Path
    limit: float
    stack: ExitStack
    _serving: int = field(default=0)

    def run(self, line: Line) -> Outcome:
        """Run a line, or start it where it serves."""
        if not line.command:
            return Outcome(line)
        before, began = _tree(self.work), time.monotonic()
        code, stdout, stderr, over = self._serve(line) if line.serves else self._wait(line)
        after = _tree(self.work)
        return Outcome(
            line, code, stdout, stderr, time.monotonic() - began, over,
            tuple(sorted(name for name, state in after.items() if before.get(name) != state)),
            tuple(sorted(before.keys() - after.keys())),
        )  # fmt: skip

    def _start(self, line: Line, stdout: Path, stderr: Path) -> subprocess.Popen[bytes]:
        environment = {
            "PATH": f"{self.programs}:/usr/bin:/bin", "HOME": str(self.work.parent),
            "LANG": "C.UTF-8", "COLUMNS": "120", "MPLBACKEND": "Agg", "TZ": "UTC",
        }  # fmt: skip
        for name in ("NUMBA_CACHE_DIR", "TMPDIR"):
            if name in os.environ:
                environment[name] = os.environ[name]
        with stdout.open("wb") as out, stderr.open("wb") as err:
            return subprocess.Popen(
                ["bash", "-c", line.command], cwd=self.work, env=environment,
                stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True,
            )  # fmt: skip

    def _wait(self, line: Line) -> tuple[int | None, str, str, bool]:
        stdout, stderr = (self.work.parent / f"{self.work.name}.{kind}" for kind in ("out", "err"))
        process = self._start(line, stdout, stderr)
        over = False
        try:
            process.wait(self.limit)
        except subprocess.TimeoutExpired:
            over = True
        with suppress(ProcessLookupError):  # what it left running, too
            os.killpg(process.pid, signal.SIGKILL)
        code = None if over else process.returncode
        process.wait()
        return code, _text(stdout), _text(stderr), over

    def _serve(self, line: Line) -> tuple[int | None, str, str, bool]:
        """Start a command that serves; return once it has said where, or has ended."""
        self._serving += 1
        stdout, stderr = (
            self.work.parent / f"{self.work.name}.{self._serving}.{kind}" for kind in ("out", "err")
        )
        process = self._start(line, stdout, stderr)
        self.stack.callback(_stop, process)
        end = time.monotonic() + FIRST_OUTPUT
        while not stdout.stat().st_size and process.poll() is None and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(0.5)
        return process.poll(), _text(stdout), _text(stderr), False


def _stop(process: subprocess.Popen[bytes]) -> None:
    for number, patience in ((signal.SIGINT, STOPPING), (signal.SIGKILL, STOPPING)):
        with suppress(ProcessLookupError, subprocess.TimeoutExpired):
            os.killpg(process.pid, number)
            process.wait(patience)
            return


def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8", errors="replace")


def _tree(folder: Path) -> dict[str, tuple[int, int, int]]:
    """Return inode, size and time of change of every file in a folder; links are not followed."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            file = Path(place) / name
            if file.is_file() and not file.is_symlink():
                state = file.stat()
                key = str(file.relative_to(folder))
                found[key] = (state.st_ino, state.st_size, state.st_mtime_ns)
    return found
