# SPDX-License-Identifier: MIT
r"""SLCAN (Lawicel): CAN frames as lines of text over a serial line, and a simulated adapter.

``t`` id(3) length data, ``T`` id(8) for 29-bit ids, ``r`` and ``R`` without data for remote frames;
hexadecimal, each line ended by a carriage return. An adapter answers a carriage return for a valid
command and a bell for an invalid one.
"""

import re
from typing import Final

import can

from rig.errors import ProtocolError

END: Final = b"\r"
"""End of a line."""
OBEYED: Final = b"\r"
"""Answer to a valid command."""
REFUSED: Final = b"\a"
"""Answer to an invalid command."""
LONGEST: Final = 32
"""Longest line of a frame with a time stamp, with some margin [bytes]."""
_FRAME: Final = re.compile(
    rb"(?:t(?P<short>[0-9A-Fa-f]{3})|T(?P<long>[0-9A-Fa-f]{8}))(?P<length>[0-8])(?P<data>[0-9A-Fa-f]*)"
    rb"|(?:r(?P<remote>[0-9A-Fa-f]{3})|R(?P<far>[0-9A-Fa-f]{8}))(?P<asked>[0-8])"
)
_HIGHEST: Final = {False: (1 << 11) - 1, True: (1 << 29) - 1}


def encode_frame(message: can.Message) -> bytes:
    r"""Encode a CAN frame as an SLCAN line, carriage return included.

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
    """Decode an SLCAN line without its carriage return; the inverse of `encode_frame`.

    Raises:
        ProtocolError: The line is not a frame, its id is too large for its kind, or its length is
            not that of its data.
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
        raise ProtocolError(f"found {line[:LONGEST]!r}; expected {int(part['length'])} data bytes")
    data = bytes.fromhex(part["data"].decode("ascii"))
    return can.Message(arbitration_id=number, is_extended_id=extended, data=data)


class SlcanAdapter:
    """Simulated adapter between a serial line and a CAN bus; implements `ByteTwin`.

    It makes the devices on the bus accessible to any program that speaks SLCAN, for example with
    python-can's `slcan` interface. Frames pass while the host has the channel open.

    Not modelled: bit rates (any is accepted), time stamps, filters, and errors of the bus.

    Args:
        bus: The adapter's end of the bus; the caller closes it.
        source: Origin of the data: `sim:WHAT`.

    Attributes:
        refused: Number of invalid lines received so far.
    """

    def __init__(self, bus: can.BusABC, *, source: str) -> None:
        self.source = source
        self.refused = 0
        self._bus = bus
        self._open = False
        self._inbox = b""

    def poll(self, now: float, received: bytes) -> bytes:
        """Execute the lines received, and return answers and the frames of the bus.

        Frames that arrive while the host has the channel closed are discarded; see `ByteTwin.poll`.

        Args:
            now: Time, not used [s].
            received: Bytes from the host since the last poll.

        Returns:
            Answers and frames as SLCAN lines.
        """
        del now
        *lines, self._inbox = (self._inbox + received).split(END)
        self._inbox = self._inbox[-LONGEST:]  # bounds the memory for noise without an end
        out = b"".join(self._execute(line) for line in lines)
        while (message := self._bus.recv(0.0)) is not None:
            if self._open:
                out += encode_frame(message)
        return out

    def _execute(self, line: bytes) -> bytes:
        """Execute one line from the host, without its carriage return, and return the answer.

        Frames are passed on, `O` and `L` open the channel and `C` closes it; settings of bit rate,
        time stamps and filters are answered but have no effect. Other lines are counted as refused
        and answered by a bell, but for the requests in `_ANSWERS`.
        """
        command = line[:1]
        if command in (b"t", b"T", b"r", b"R"):
            return self._pass_on(line)
        if command in (b"O", b"L", b"C") and len(line) == 1:
            self._open = command != b"C"
            return OBEYED
        if command in (b"", b"S", b"s", b"Y", b"M", b"m", b"Z"):
            return OBEYED  # an empty line, and settings without effect here
        if line in _ANSWERS:
            return _ANSWERS[line] + END
        self.refused += 1
        return REFUSED

    def _pass_on(self, line: bytes) -> bytes:
        """Send the frame of a line to the bus; refuse an invalid one, or all while not open."""
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
"""Answers to the requests for status, version and serial number, without their end."""
