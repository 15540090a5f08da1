# SPDX-License-Identifier: MIT
"""Known errors of photographs become known errors of the lab: one line, exit code 1."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_line() -> Iterator[None]:
    """Convert what `tracking` raises on purpose while the body runs.

    Raises:
        DataError: The body raised a `TrackingError`; the message is the same.
    """
    from tracking.errors import TrackingError
    from zebro_lab.errors import DataError

    try:
        yield
    except TrackingError as error:
        raise DataError(str(error)) from error
