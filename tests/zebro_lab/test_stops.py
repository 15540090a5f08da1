# SPDX-License-Identifier: MIT
"""SIGTERM and Ctrl-C at random instants of every command: a code, one line, and no half result.

A new command needs an entry in `WORK`: arguments with which it takes a few seconds at most.
"""

import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import pytest

from support.bundled_walk import PHOTOS, SOME, WALK
from support.command_tree import LEAVES, named
from support.commands import COMMAND, started
from support.compared_folders import calibration
from support.experiment_plans import short_plan
from support.other_labs import write_walk_tables
from support.short_calibration import calibration_folder
from support.written_runs import make_run
from zebro_lab.experiment.journal import read_journal
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.folder import find_runs, read_slip_rig_run
from zebro_lab.runs.manifest import read_manifest

STOPPED = 130
ENDED_BY = {signal.SIGTERM: -signal.SIGTERM, signal.SIGINT: -signal.SIGINT}
"""Exit codes where Python had not begun, or had finished, the command's own work."""
INSTANTS = {signal.SIGTERM: 5, signal.SIGINT: 2}
"""How often each command is stopped by a signal."""
AT_ONCE = (
    "stopped by (SIGTERM|Ctrl-C); nothing was left half-written|"
    "stopped( before sampling began)?; nothing was written"
)
RESUMED = "stopped; fit/checkpoint.npz keeps the fit; go on with: .* --resume"
BENCH = f"--camera {WALK}/camera.toml --floor {WALK}/floor.toml --robot {WALK}/robot.toml"
FIT = "rig --out fit --law coulomb-stribeck --max-steps 200 --threads 2"


def whole_or_nothing(folder: Path, new: set[str], whole: set[str]) -> None:
    """Allow all that the command writes, or no trace of it."""
    assert new in (set(), whole), folder


def a_recorded_run(folder: Path, new: set[str], whole: set[str]) -> None:
    """Allow a run of `record`, with how it ended and a log that is whole."""
    assert new <= whole
    for run in (folder / "recorded").glob("*"):
        manifest = read_manifest(run)
        assert re.match("stopped: SIG(TERM|INT)|completed", manifest.exit_status)
        log = read_raw_log(run / "log.mcap")
        assert log.damage is None
        assert {topic: len(found) for topic, found in log.streams.items()} == manifest.streams


def an_experiment_to_resume(folder: Path, new: set[str], whole: set[str]) -> None:
    """Allow an experiment with whole runs, which can be resumed: nothing holds it any more."""
    assert {Path(name).parts[0] for name in new} <= {"experiment"}
    assert not {name for name in new - whole if Path(name).name.startswith((".", "control"))}
    if "experiment" in new:
        closed = read_journal(folder / "experiment").folders
        for run in find_runs(folder / "experiment"):
            assert run.name in closed
            if read_manifest(run).excluded is None:  # others may have been stopped without a sample
                read_slip_rig_run(run)


def a_fit_to_resume(folder: Path, new: set[str], whole: set[str]) -> None:
    """Allow all results of a fit, or its checkpoint."""
    assert new in (set(), whole, {"fit", "fit/checkpoint.npz"}), folder


@dataclass(frozen=True)
class Work:
    """How a command is started in a prepared folder, and what it may leave when it is stopped.

    Attributes:
        arguments: Its arguments, as on a command line.
        answers: What it reads from standard input.
        keeps: Checks the new files of a command that was stopped, of which those of one that was
            not are given as well.
        says: Pattern of the line on stderr with which it ends when it is stopped; lines before it
            are progress, or questions.
        heard: Exit codes, besides `STOPPED`, of a command that takes a stop for its end.
    """

    arguments: str = ""
    answers: str = ""
    keeps: Callable[[Path, set[str], set[str]], None] = whole_or_nothing
    says: str = AT_ONCE
    heard: tuple[int, ...] = ()


RECORD = "--zebro sim --imu sim --duration 2 --label x --data recorded"
MARKS = "--click simulated_03.jpg:door=10,20 --delete simulated_06.jpg"
CHECKED = "\n".join([*(f"{leg}\ny" for leg in range(1, 7)), "", ""])
SERVED = Work("--duration 1", heard=(0,))
WORK = {
    "zebro-lab calibrate": Work(FIT, keeps=a_fit_to_resume, says=f"{AT_ONCE}|{RESUMED}"),
    "calibrate-slip": Work(FIT, keeps=a_fit_to_resume, says=f"{AT_ONCE}|{RESUMED}"),
    "zebro-lab read-off": Work("rig --out read"),
    "zebro-lab init": Work("bench.csv --kind rig"),
    "zebro-lab walk": Work("--slip coulomb:0.4 --duration 4 --figures --out walked"),
    "zebro-lab reach": Work("--goal 0.3,0.1 --slip coulomb:0.4 --out reached"),
    "zebro-lab predict": Work("data/walk --slip coulomb:0.4 --draws 50 --out predicted"),
    "zebro-lab validate": Work("data/walk --out judged"),
    "zebro-lab compare": Work("one other --out compared"),
    "zebro-lab report": Work("data/walk --out page.html"),
    "zebro-lab record": Work(RECORD, keeps=a_recorded_run, says=f"{AT_ONCE}|"),
    "zebro-lab import": Work(f"--legs {WALK}/legs.csv --imu {WALK}/imu.csv --data data"),
    "zebro-lab runs": Work("data"),
    "zebro-lab plot": Work("data/walk --out legs.png"),
    "zebro-lab exclude": Work("data/rig --why worn"),
    "zebro-lab export": Work("data/walk --to csv --out tables"),
    "zebro-lab track": Work(f"photos {BENCH} --out tracked"),
    "zebro-lab annotate": Work(f"{PHOTOS} --out said.toml {MARKS}"),
    "zebro-lab doctor": Work(),
    "zebro-lab camera kit": Work("--out kit"),
    "zebro-lab camera calibrate": Work(
        f"{WALK}/calibration --board charuco:9x6:40mm:30mm:4x4_50 --out camera.toml"
    ),
    "zebro-lab camera clock": SERVED,
    "zebro-lab rig plan": Work("plan.toml"),
    "zebro-lab rig run": Work(
        "plan.toml --rig sim --fast --data experiment",
        keeps=an_experiment_to_resume,
        says=f"{AT_ONCE}|",
    ),
    "zebro-lab rig say": Work("status --data data"),
    "zebro-lab rig weigh": Work("--rig sim --fast --masses 0.2,1 --data weighed"),
    "zebro-lab rig check": Work("data/rig --slip one"),
    "zebro-lab rig suggest": Work(
        "plan.toml --calibration fitted --target slip_stiffness --rate 40 --time 300"
    ),
    "zebro-lab sim zebro": SERVED,
    "zebro-lab sim rig": SERVED,
    "zebro-lab sim imu": SERVED,
    "zebro-lab zebro check": Work("sim --save mine.toml", CHECKED, says=f"(.*: )?({AT_ONCE})"),
}


def test_every_command_is_stopped():
    assert set(WORK) == {named(found) for found in LEAVES}


@pytest.mark.parametrize("after", [0.15, 0.6, 1.1])
def test_a_walk_is_stopped_at_any_moment(after, tmp_path):
    code = stop("zebro-lab walk", signal.SIGTERM, after=after, folder=tmp_path)
    assert code in {STOPPED, ENDED_BY[signal.SIGTERM]}
    assert not list(tmp_path.iterdir())


class Whole(NamedTuple):
    """How a command ends that is not stopped: exit code, time [s], and new and changed files."""

    code: int
    lasts: float
    new: set[str]


@pytest.fixture(scope="session")
def prepared(tmp_path_factory, sweep) -> Path:
    """Return a folder with what the commands in `WORK` read."""
    folder = tmp_path_factory.mktemp("prepared")
    calibration(folder / "one")
    calibration(folder / "other", friction=0.5)
    calibration_folder(folder / "fitted")
    shutil.copytree(sweep, folder / "rig")
    shutil.copy(sweep / "sweep.csv", folder / "bench.csv")
    short_plan(folder)
    (folder / "photos").mkdir()
    for number in SOME:
        shutil.copy(PHOTOS / f"simulated_{number}.jpg", folder / "photos")
    make_run(folder / "data").rename(folder / "data" / "rig")
    tables = tmp_path_factory.mktemp("tables")
    write_walk_tables(tables)
    for command in (
        f"import --legs {tables}/legs.tsv --track {tables}/capture.csv --robot {WALK}/robot.toml "
        "--label walk --data made --start 2026-03-04T05:06:07+00:00",
        "predict made/20260304T050607Z_walk_walk --slip coulomb:0.4 --draws 50",
        "validate made/20260304T050607Z_walk_walk",
    ):
        subprocess.run([COMMAND, *command.split()], cwd=folder, check=True, capture_output=True)
    (folder / "made" / "20260304T050607Z_walk_walk").rename(folder / "data" / "walk")
    (folder / "made").rmdir()
    return folder


@pytest.fixture(scope="session")
def whole(prepared, tmp_path_factory) -> Callable[[str], Whole]:
    """Return what runs a command to its end, once."""
    known: dict[str, Whole] = {}

    def ended(name: str) -> Whole:
        if name not in known:
            folder = tmp_path_factory.mktemp("whole") / "work"
            shutil.copytree(prepared, folder)
            before, began = contents(folder), time.monotonic()
            with running(name, folder) as process:
                process.communicate(WORK[name].answers, timeout=300)
            lasts = time.monotonic() - began
            known[name] = Whole(process.returncode, lasts, changed(before, contents(folder)))
        return known[name]

    return ended


@contextmanager
def running(name: str, folder: Path) -> Iterator[subprocess.Popen[str]]:
    """Run a command of `WORK` in a folder and in a session of its own."""
    words = name.split()
    with started(
        *words[1:], *WORK[name].arguments.split(), command=words[0], cwd=folder,
        stdin=subprocess.PIPE, start_new_session=True,
    ) as process:  # fmt: skip
        yield process


def contents(folder: Path) -> dict[str, str]:
    """Return a hash of each file in and below a folder, empty for a folder, by its path."""
    return {
        str(path.relative_to(folder)): "" if path.is_dir() else digest(path)
        for path in folder.rglob("*")
    }


def digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    """Return the paths that are new, changed or gone; times in names are left out."""
    different = {name for name in before | after if before.get(name) != after.get(name)}
    return {re.sub(r"\d{8}T\d{6}Z", "TIME", name) for name in different}


def stop(name: str, number: signal.Signals, *, after: float, folder: Path) -> int:
    """Stop a command after a time [s]; check code and words, and that no process is left.

    Ctrl-C reaches each process of a terminal's session, SIGTERM the command alone.
    """
    work = WORK[name]
    with running(name, folder) as process:
        process.stdin.write(work.answers)
        process.stdin.flush()
        time.sleep(after)
        if number == signal.SIGINT and process.poll() is None:
            os.killpg(process.pid, number)
        else:
            process.send_signal(number)
        _, err = process.communicate(timeout=60)
        code = process.returncode
        if "from zebro_lab.start import" not in err:  # else Python was still on its way to our code
            assert "Traceback" not in err, err
        if code == STOPPED:
            *others, last = err.splitlines() or [""]
            assert re.fullmatch(work.says, last), err
            assert not any("stopped" in line for line in others), err
        assert session_ends(process.pid)
    return code


def session_ends(group: int) -> bool:
    """Return whether the processes that a command has started end within 2 s."""
    end = time.monotonic() + 2
    while time.monotonic() < end:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.02)
    return False


STOPS = [
    (name, number, instant)
    for name in WORK
    for number, times in INSTANTS.items()
    for instant in range(times)
]


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "number", "instant"), STOPS, ids=lambda each: getattr(each, "name", str(each))
)
def test_a_command_is_stopped_at_random_instants(name, number, instant, prepared, whole, tmp_path):
    seed = f"{name} {number.name} {instant}"
    fraction = (instant + random.Random(seed).random()) / INSTANTS[number]  # noqa: S311
    expected, work = whole(name), WORK[name]
    folder = tmp_path / "work"
    shutil.copytree(prepared, folder)
    before = contents(folder)
    code = stop(name, number, after=fraction * expected.lasts, folder=folder)
    new = changed(before, contents(folder))
    print(f"{seed}: at {fraction:.0%} of {expected.lasts:.1f} s, exit code {code}")  # noqa: T201
    assert code in {STOPPED, ENDED_BY[number], expected.code, *work.heard}
    work.keeps(folder, new, expected.new)
    assert code != expected.code or new == expected.new or code in work.heard
