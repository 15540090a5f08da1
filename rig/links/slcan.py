# SPDX-License-Identifier: MIT
r"""CAN frames as lines of text, as adapters on a serial line speak (SLCAN, after Lawicel's).

``t`` id(3) length data, ``T`` id(8) for 29-bit ids, ``r`` and ``R`` without data for remote frames;
hexadecimal, each line ended by a carriage return. An adapter answers a carriage return where it
obeys and a bell where it does not.
"""

import re
from typing import Final

import can

from rig.errors import ProtocolError

END: Final = b"\r"
OBEYED: Final = b"\r"
REFUSED: Final = b"\a"
LONGEST: Final = 32
"""Longest line of a frame with a time stamp, and to spare [bytes]."""
_FRAME: Final = re.compile(
    rb"(?:t(?P<short>[0-9A-Fa-f]{3})|T(?P<long>[0-9A-Fa-f]{8}))(?P<length>[0-8])(?P<data>[0-9A-Fa-f]*)"
    rb"|(?:r(?P<remote>[0-9A-Fa-f]{3})|R(?P<far>[0-9A-Fa-f]{8}))(?P<asked>[0-8])"
)
_HIGHEST: Final = {False: (1 << 11) - 1, True: (1 << 29) - 1}


def encode_frame(message: can.Message) -> bytes:
    r"""Make the line of a frame, with its end.

    >>> encode_frame(can.Message(arbitration_id=0x121, data=b"\x01\xff", is_extended_id=False))
    b't121201FF\r'
    """
    number = f"{message.arbitration_id:08X}" if message.is_extended_id else (
        f"{message.arbitration_id:03X}")  # fmt: skip
    letter = "r" if message.is_remote_frame else "t"
    letter = letter.upper() if message.is_extended_id else letter
    data = "" if message.is_remote_frame else bytes(message.data).hex().upper()
    return f"{letter}{number}{message.dlc:d}{data}".encode("ascii") + END


def decode_frame(line: bytes) -> can.Message:
    """Read the line of a frame, without its end; the inverse of `encode_frame`.

    Raises:
        ProtocolError: The line is no frame, or an id or a length is not right.
    """
    found = _FRAME.fullmatch(line)
    if found is None:
        raise ProtocolError(f"found {line[:LONGEST]!r}; expected a frame such as t1232ABCD")
    part = found.groupdict()
    extended = part["long"] is not None or part["far"] is not None
    number = int(part["short"] or part["long"] or part["remote"] or part["far"] or b"", 16)
    if number > _HIGHEST[extended]:
        raise ProtocolError(f"found id {number:#x}; expected at most {_HIGHEST[extended]:#x}")
    if part["asked"] is not None:
        return can.Message(arbitration_id=number, is_extended_id=extended, is_remote_frame=True,
                           dlc=int(part["asked"]))  # fmt: skip
    if len(part["data"]) != 2 * int(part["length"]):
        raise ProtocolError(f"found {line[:LONGEST]!r}; its length is not that of its data")
    data = bytes.fromhex(part["data"].decode("ascii"))
    return can.Message(arbitration_id=number, is_extended_id=extended, data=data)


class SlcanAdapter:
    """A simulated adapter between a serial line and a bus; satisfies `ByteTwin`.

    Whatever is at the other end of the bus is thereby reached from any program that speaks SLCAN,
    python-can's `slcan` interface among them. Frames pass while the channel is open, as the host
    asks for it.

    Not modelled: bit rates (any is taken), time stamps, filters, and errors of the bus.

    Args:
        bus: The adapter's own end of the bus; whoever made it closes it.
        source: What is at the other end: `sim:WHAT`.

    Attributes:
        refused: Lines that were no command and no frame.
    """

    def __init__(self, bus: can.BusABC, *, source: str) -> None:
        self.source = source
        self.refused = 0
        self._bus = bus
        self._open = False
        self._inbox = b""

    def poll(self, now: float, received: bytes) -> bytes:
        """Execute the lines received and return the frames of the bus; see `ByteTwin.poll`.

        Args:
            now: Time, not used [s].
            received: Bytes from the host since the last poll.

        Returns:
            Answers and frames as SLCAN lines.
        """
        del now
        *lines, self._inbox = (self._inbox + received).split(END)
        self._inbox = self._inbox[-LONGEST:]  # noise without an end must not fill the memory
        out = b"".join(self._obey(line) for line in lines)
        while (message := self._bus.recv(0.0)) is not None:
            if self._open:
                out += encode_frame(message)
        return out

    def _obey(self, line: bytes) -> bytes:
        command = line[:1]
        if command in (b"t", b"T", b"r", b"R"):
            return self._pass_on(line)
        if command in (b"O", b"L", b"C") and len(line) == 1:
            self._open = command != b"C"
            return OBEYED
        if command in (b"", b"S", b"s", b"Y", b"M", b"m", b"Z"):
            return OBEYED  # an empty line, and settings that change nothing here
        if line in _ANSWERS:
            return _ANSWERS[line] + END
        self.refused += 1
        return REFUSED

    def _pass_on(self, line: bytes) -> bytes:
        try:
            message = decode_frame(line)
        except ProtocolError:
            self.refused += 1
            return REFUSED
        if not self._open:
            return REFUSED
        self._bus.send(message)
        return (b"Z" if message.is_extended_id else b"z") + OBEYED


_ANSWERS: Final = {b"F": b"F00", b"V": b"V0101", b"N": b"NSIM1"}
"""Status, version and serial number."""
