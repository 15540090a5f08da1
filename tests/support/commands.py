# SPDX-License-Identifier: MIT
"""The installed command, started as a process of its own or run within this one."""

import contextlib
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from zebro_lab.main import app, slip_app
from zebro_lab.terminal.ending import run

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))


class Ended(NamedTuple):
    """How a command ended: exit code, and what it printed."""

    code: int
    out: str
    err: str


def within_process(monkeypatch, capsys) -> Callable[..., Ended]:
    """Return what runs `zebro-lab` with arguments in this process, which saves its start.

    The first argument `calibrate-slip` runs that command.
    """

    def run_with(*arguments: object) -> Ended:
        words, command = [COMMAND, *map(str, arguments)], app
        if words[1:2] == ["calibrate-slip"]:
            words, command = words[1:], slip_app
        monkeypatch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit) as ended:
            run(command)
        return Ended(int(ended.value.code or 0), *capsys.readouterr())

    return run_with


@contextlib.contextmanager
def started(
    *arguments: object, command: str = "zebro-lab", **options
) -> Iterator[subprocess.Popen[str]]:
    """Run a command beside this process; kill it at the latest when the body ends.

    Args:
        arguments: Its arguments, as on a command line.
        command: Its name.
        options: Options of `subprocess.Popen`.
    """
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, **options}
    process = subprocess.Popen([Path(COMMAND).with_name(command), *map(str, arguments)], **options)
    try:
        yield process
    except AssertionError:  # show what it printed
        process.kill()
        print(*process.communicate())  # noqa: T201 - pytest shows it
        raise
    finally:
        process.kill()
        process.communicate()
