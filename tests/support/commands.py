# SPDX-License-Identifier: MIT
"""The installed command, started as a process of its own."""

import contextlib
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))


@contextlib.contextmanager
def started(*arguments: object, **options) -> Iterator[subprocess.Popen[str]]:
    """Run the command beside this process; kill it at the latest when the body ends.

    Args:
        arguments: Its arguments, as on a command line.
        options: Options of `subprocess.Popen`.
    """
    process = subprocess.Popen(
        [COMMAND, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        **options,
    )  # fmt: skip
    try:
        yield process
    except AssertionError:  # show what it printed
        process.kill()
        print(*process.communicate())  # noqa: T201 - pytest shows it
        raise
    finally:
        process.kill()
        process.communicate()
