# SPDX-License-Identifier: MIT
"""Work that must end soon, whatever file it is given."""

import threading

from tracking.errors import TrackingError


def within_two_seconds(work):
    """Do something in a thread, and return what it raised or returned."""
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
