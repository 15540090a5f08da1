# SPDX-License-Identifier: MIT
"""The laboratory's end of `stop_latency.py`: the real `zebro-lab rig run` on a terminal of its own.

The command runs in a process forked from one that has its imports already; apart from that, and
from what is planted into it on SIGUSR1, it is the one that a user starts.
"""

import contextlib
import errno
import os
import pty
import queue
import re
import select
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from typing import Any, Final, NoReturn

from rig.links import can, serial, slcan, udp  # noqa: F401 - forked with it
from rig.slip_rig import board, drives, load_cell  # noqa: F401
from zebro_lab.experiment import stage as rig_run  # noqa: F401
from zebro_lab.experiment.screen import ExperimentScreen, Keyboard
from zebro_lab.main import main
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.recording.recorder import RunRecorder

DEADLY_KEY: Final = b"~"
"""What ends the keyboard's thread where that is planted."""
_CONTROL: Final = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[()][A-Z0-9]|\r")


class Lab:
    """A `zebro-lab` command on a pseudo-terminal.

    Args:
        arguments: Of the command.
        planted: What is to fail inside it on SIGUSR1; empty where nothing.

    Attributes:
        output: What it wrote to the terminal so far.
        code: Its exit code, negative where a signal ended it; None while it runs.
    """

    def __init__(self, arguments: list[str], *, planted: str = "") -> None:
        self.output = ""
        self.code: int | None = None
        self._pid, self._terminal = pty.fork()
        if self._pid == 0:
            _be_the_lab(arguments, planted)

    def type(self, keys: bytes) -> None:
        """Type on its keyboard."""
        with contextlib.suppress(OSError):
            os.write(self._terminal, keys)

    def signal(self, number: int) -> None:
        """Send it a signal."""
        os.kill(self._pid, number)

    def hang_up(self) -> None:
        """Close its terminal."""
        os.close(self._terminal)
        self._terminal = -1

    def watch(self, until: Callable[[], bool], limit: float) -> bool:
        """Read its terminal until something holds or it ends; tell whether it came to hold."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            self._read()
            if until():
                return True
            if self.code is not None:
                return False
        return False

    def wait(self, limit: float) -> int | None:
        """Let it end; return its exit code, None where it does not end within the limit [s]."""
        self.watch(lambda: self.code is not None, limit)
        return self.code

    def close(self) -> None:
        """End it."""
        if self.code is None:
            self.signal(signal.SIGKILL)
            self._reap(0)
        if self._terminal >= 0:
            self.hang_up()

    @property
    def last_lines(self) -> str:
        """The last lines on its terminal, as words with single blanks between."""
        lines = [line for line in _CONTROL.sub("", self.output).split("\n") if line.strip()]
        return " ".join(" ".join(lines[-4:]).split())

    def _read(self) -> None:
        if self._terminal < 0:
            time.sleep(0.005)
            self._reap(os.WNOHANG)
            return
        with contextlib.suppress(OSError):  # its end closes the terminal, after the last words
            while select.select([self._terminal], [], [], 0.005)[0]:
                data = os.read(self._terminal, 65_536)
                if not data:
                    break
                self.output += data.decode("utf-8", "replace")
        self._reap(os.WNOHANG)

    def _reap(self, flags: int) -> None:
        pid, status = os.waitpid(self._pid, flags) if self.code is None else (0, 0)
        if pid:
            self.code = os.waitstatus_to_exitcode(status)


def _be_the_lab(arguments: list[str], planted: str) -> NoReturn:
    """Be the command, in the forked process."""
    code: Any = 99
    try:
        sys.stdin = os.fdopen(0)
        sys.stdout, sys.stderr = os.fdopen(1, "w", buffering=1), os.fdopen(2, "w")
        os.environ |= {"TERM": "xterm", "COLUMNS": "200", "LINES": "50"}
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)  # whatever started this program ignores
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.argv = ["zebro-lab", *arguments]
        _plant(planted)
        main()
    except SystemExit as left:
        code = left.code or 0
    except BaseException:  # noqa: BLE001, RUF100 - shown, and exit code 99
        traceback.print_exc()
    with contextlib.suppress(OSError, ValueError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(code)


def _plant(what: str) -> None:
    """Prepare a part to fail on SIGUSR1, or on its key."""
    if what == "keyboard":
        _break(Keyboard, "take", lambda data: DEADLY_KEY in data, RuntimeError("planted"))
        return
    if not what:
        return
    asked: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: asked.append(number))
    owner, method, error = {
        "writer's job": (RunRecorder, "write", UnicodeEncodeError("utf-8", "?", 0, 1, "planted")),
        "writer's thread": (queue.Queue, "get", MemoryError("planted")),
        "log's thread": (LogWriter, "write", RuntimeError("planted")),
        "no space": (LogWriter, "flush", OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))),
        "screen": (ExperimentScreen, "draw", RuntimeError("planted")),
    }[what]

    def now(*_: Any) -> bool:
        writes = threading.current_thread().name == "writer"
        return bool(asked) and (writes or what != "writer's thread")

    _break(owner, method, now, error)


def _break(owner: Any, method: str, when: Callable[..., bool], error: Exception) -> None:
    whole = getattr(owner, method)

    def broken(self: Any, *args: Any, **kwargs: Any) -> Any:
        if when(*args):
            raise error
        return whole(self, *args, **kwargs)

    setattr(owner, method, broken)


def latch_holds(arguments: list[str]) -> bool:
    """Tell whether `--resume` is refused for an emergency stop that is latched."""
    lab = Lab([*arguments, "--resume"])
    try:
        return lab.wait(20.0) == 1 and "is latched" in lab.last_lines
    finally:
        lab.close()
