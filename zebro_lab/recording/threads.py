# SPDX-License-Identifier: MIT
"""Convert a failure to start a thread to an error of one line."""

from collections.abc import Iterator
from contextlib import contextmanager

from zebro_lab.files.errors import RecordingError


@contextmanager
def needing_threads() -> Iterator[None]:
    """Convert a failure to start a thread in the `with` statement to a `RecordingError`.

    Raises:
        RecordingError: A thread could not be started. Other exceptions pass unchanged.
    """
    try:
        yield
    except RuntimeError as error:
        if "start new thread" not in str(error):
            raise
        raise RecordingError(
            f"{error}: the system allows no more threads; close other programs, or raise the "
            "limit of threads (ulimit -u)"
        ) from error
