# SPDX-License-Identifier: MIT
"""A simulated device at a port that any program can open."""

import contextlib
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from zebro_lab.main import app
from zebro_lab.terminal.ending import run as run_app

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))


@pytest.fixture
def run(monkeypatch, capsys):
    """Return a runner of the command in this process: exit code, stdout, stderr."""

    def runner(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", [COMMAND, *map(str, arguments)])
        try:
            with pytest.raises(SystemExit) as ended:
                run_app(app)
            code = ended.value.code
        finally:
            streams = capsys.readouterr()
        return int(code or 0), streams.out, streams.err

    return runner


@contextlib.contextmanager
def started(*arguments, **options):
    """Run the command beside this process; it is killed at the latest when the body ends."""
    process = subprocess.Popen(
        [COMMAND, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        **options,
    )  # fmt: skip
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def test_a_twin_prints_its_port_and_any_program_can_record_it(run, tmp_path):
    with started("sim", "zebro", "--socket", "--drop", "0.1", "--seed", "3") as twin:
        line = twin.stdout.readline()
        assert line.startswith("SIMULATED robot (sim:zebro), profile zebro-100-serial: socket://")
        port = line.split()[-1]
        code, out, _ = run("record", "--zebro", f"zebro-100-serial@{port}", "--duration", 1.0,
                           "--label", "x", "--data", tmp_path)  # fmt: skip
        twin.send_signal(signal.SIGTERM)
        assert twin.wait(20) == 0
    assert code == 0
    received, lost = map(int, re.search(r"legs: (\d+) samples, (\d+) lost", out).groups())
    assert received > 50
    assert 0 < lost < 0.3 * received
