# SPDX-License-Identifier: MIT
"""Time limit for reading malformed files."""

import threading

from tracking.errors import TrackingError


def within_two_seconds(work):
    """Call a function in a thread, and return its result or `TrackingError`; None on timeout."""
    said = []

    def run():
        try:
            said.append(work())
        except TrackingError as error:
            said.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(2.0)
    return said[0] if said else None
