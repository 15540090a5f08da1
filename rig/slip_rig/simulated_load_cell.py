# SPDX-License-Identifier: MIT
"""A simulated Net F/T load cell at a loopback UDP port.

Not modelled: its web page, its thresholds, and the low-pass filter inside it.
"""

import contextlib
import socket
from typing import Self

import numpy as np

from rig.links.faults import PERFECT_LINE, Faults, FaultyLine
from rig.slip_rig.load_cell import MAGIC, MOST_IN_ONE, RECORD, REQUEST, WRAP, Request
from rig.slip_rig.profile import LoadCellProfile
from rig.slip_rig.simulated import SimulatedRig

INT32 = (1 << 31) - 1


class SimulatedLoadCell:
    """Simulated Net F/T cell that answers start and stop; its socket is open while entered.

    Args:
        rig: Simulated rig whose forces the cell measures.
        profile: Counts, axes and rate of the cell; the profile's address is not used.
        faults: Transmission errors; `drop`, `duplicate`, `delay` and `truncate` apply to datagrams.
        rng: Random generator of the transmission errors.

    Attributes:
        host: Loopback address.
        port: UDP port assigned by the system; 0 until the cell is entered.
        sent: Number of records sent so far, including those that the faults drop.
        status: Status word of all later records.
        lateral_force: Force on the third axis, which the rig does not load [N].
        torque: Torque about each of the three axes; 0 counts where the profile has no scale [N m].
    """

    def __init__(
        self,
        rig: SimulatedRig,
        *,
        profile: LoadCellProfile,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:rig"
        self.host = "127.0.0.1"
        self.port = 0
        self.sent = 0
        self.status = 0
        self.lateral_force = 0.0
        self.torque = 0.0
        self._rig = rig
        self._profile = profile
        self._line: FaultyLine[bytes] = FaultyLine(faults, rng=rng)
        self._socket: socket.socket | None = None
        self._client: tuple[str, int] | None = None
        self._number = 0
        self._reading = 0
        self._each = 1  # records in a datagram
        self._pending: list[bytes] = []

    def __enter__(self) -> Self:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((self.host, 0))
        self._socket.setblocking(False)
        self.port = self._socket.getsockname()[1]
        return self

    def __exit__(self, *exception: object) -> None:
        if self._socket is not None:
            self._socket.close()
        self._socket = None

    def poll(self, now: float) -> None:
        """Simulate the rig up to `now` [s], execute requests, and send the records that are due."""
        self._rig.advance(now)
        due = int(self._rig.elapsed(now) * self._profile.rate + 1e-6)
        readings = np.arange(self._reading + 1, due + 1)
        if len(readings) == 0:
            return
        counts = self._counts(readings)
        self._reading = due
        self._execute()
        if self._client is not None:
            for reading, values in zip(readings.tolist(), counts.tolist(), strict=True):
                self._send(reading, values)

    def _counts(self, readings: np.ndarray) -> np.ndarray:
        """Compute the counts of readings by their numbers, columns Fx to Tz, shape (n, 6)."""
        normal, traction = self._rig.forces(readings / self._profile.rate)
        counts = np.zeros((len(readings), 6))
        counts[:, 3 - self._profile.normal.index - self._profile.traction.index] = (
            self.lateral_force * self._profile.counts_per_force
        )
        counts[:, 3:] = self.torque * (self._profile.counts_per_torque or 0.0)
        for axis, force in ((self._profile.normal, normal), (self._profile.traction, traction)):
            counts[:, axis.index] += axis.sign * force * self._profile.counts_per_force
        return np.clip(np.rint(counts), -INT32, INT32).astype(np.int64)

    def _send(self, reading: int, values: list[int]) -> None:
        """Add the record of a reading to the datagram, and send that once it is complete."""
        self._number += 1
        self.sent += 1
        record = RECORD.pack(self._number % WRAP, reading % WRAP, self.status, *values)
        self._pending.append(record)
        if len(self._pending) >= self._each:
            datagram, self._pending = b"".join(self._pending), []
            for arrived in self._line.carry(datagram, lambda whole: whole[:-16]):
                self._emit(arrived)

    def _emit(self, datagram: bytes) -> None:
        """Send a datagram to the client, if there is one."""
        if self._socket is not None and self._client is not None:
            with contextlib.suppress(OSError):  # the client has closed its socket
                self._socket.sendto(datagram, self._client)

    def _execute(self) -> None:
        """Execute all requests that have arrived."""
        if self._socket is None:
            return
        with contextlib.suppress(BlockingIOError):
            while True:
                try:
                    data, sender = self._socket.recvfrom(64)
                except ConnectionError:
                    continue
                self._handle(data, sender)

    def _handle(self, data: bytes, sender: tuple[str, int]) -> None:
        """Start records for the sender, numbered from 1 again, or stop them; ignore other data."""
        if len(data) != REQUEST.size:
            return
        magic, request, _ = REQUEST.unpack(data)
        if magic != MAGIC:
            return
        if request in (Request.START, Request.START_BUFFERED):
            self._client, self._number, self._pending = sender, 0, []
            self._each = MOST_IN_ONE if request == Request.START_BUFFERED else 1
        elif request == Request.STOP:
            self._client = None
