# SPDX-License-Identifier: MIT
"""What a byte stream to a device is, and what sits at its other end in a simulation."""

from typing import Protocol


class ByteLink(Protocol):
    """Bytes to and from one device."""

    @property
    def source(self) -> str:
        """Where the bytes come from: `real` or `sim:WHAT`."""
        ...

    @property
    def reconnected(self) -> int:
        """Count the times that the link came back after it was gone."""
        ...

    def open(self) -> None:
        """Open the link.

        Raises:
            LinkError: There is no such port, or no right to open it.
        """
        ...

    def close(self) -> None:
        """Close the link; a second call has no effect."""
        ...

    def read(self, timeout: float) -> bytes:
        """Hand on the bytes that have arrived, waiting at most `timeout` for the first [s].

        A link that is gone gives no bytes and tries to come back.
        """
        ...

    def write(self, data: bytes) -> bool:
        """Send bytes; return whether the link took them.

        Raises:
            RigTimeout: The port does not take bytes.
        """
        ...


class ByteTwin(Protocol):
    """A simulated device at the far end of a byte stream.

    It has no thread and no clock: whoever serves it says what time it is. So the same twin runs in
    a test by hand and behind a pseudo-terminal in real time.
    """

    @property
    def source(self) -> str:
        """What is simulated, as it goes into manifests: `sim:WHAT`."""
        ...

    def poll(self, now: float, received: bytes) -> bytes:
        """Take what the host sent and give what the device sends up to a time.

        Args:
            now: Time, never less than before [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        ...
