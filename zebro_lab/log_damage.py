# SPDX-License-Identifier: MIT
"""What the mcap library raises where a log is cut short or damaged."""

import struct

DAMAGES_HINT = "the file ends early"
"""What to say where the exception says nothing, as the reader's EndOfFile."""


def log_damages() -> tuple[type[Exception], ...]:
    """Return the exceptions to catch while a log is read; mcap is loaded only now.

    `ValueError` also covers the reader's CRC errors and text that is no UTF-8, `OverflowError` a
    length beyond 2**63.
    """
    import zstandard
    from mcap.exceptions import McapError

    return (
        McapError, struct.error, zstandard.ZstdError, ValueError, OverflowError, MemoryError
    )  # fmt: skip
