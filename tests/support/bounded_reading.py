# SPDX-License-Identifier: MIT
"""Check that a file is refused with one line, without much memory, and without blocking."""

import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from rig.errors import RigError
from zebro_lab.files.errors import ZebroLabError

LONGEST_MESSAGE = 2000


def refusal(reader: Callable[[Path], object], file: Path, *, megabytes: int = 300) -> str:
    """Read a file that cannot be read, and return the one-line message of the error.

    Args:
        reader: Reads the file.
        file: File or folder to read.
        megabytes: Memory that reading may take [MB].
    """
    before = reset_peak_memory()
    with pytest.raises((ZebroLabError, RigError)) as raised:
        reader(file)
    message = str(raised.value)
    assert "\n" not in message
    assert len(message) < LONGEST_MESSAGE
    assert peak_memory() - before < 1024 * megabytes
    return message


def peak_memory() -> int:
    """Return the largest memory of this process since `reset_peak_memory` [kB]; Linux only."""
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0])


def reset_peak_memory() -> int:
    """Reset the largest memory to the present one, and return it [kB]; Linux only."""
    Path("/proc/self/clear_refs").write_text("5")
    return peak_memory()


def error_on_fifo(reader: Callable[[Path], object], fifo: Path) -> object:
    """Make a FIFO, read it, and return the error; fail if the reader still waits after 2 s.

    Args:
        reader: Reads a file.
        fifo: Where to make the FIFO.
    """
    os.mkfifo(fifo)
    outcome: list[object] = []

    def read() -> None:
        try:
            outcome.append(reader(fifo))
        except (ZebroLabError, RigError) as error:
            outcome.append(error)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    thread.join(2.0)
    if thread.is_alive():
        os.close(os.open(fifo, os.O_RDWR | os.O_NONBLOCK))  # lets the thread end
        pytest.fail("still waiting after 2 s")
    return outcome[0]
