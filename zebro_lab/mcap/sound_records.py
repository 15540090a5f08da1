# SPDX-License-Identifier: MIT
"""Read the records of an MCAP file, also behind damaged bytes: from the next whole chunk on.

The readers of the library `mcap` end at the first damage, or need the index at the end, which a
truncated file has lost. A chunk is found by the name of its compression, at a fixed place in it,
and proved by two lengths that agree and its checksum.
"""

import re
import zlib
from collections.abc import Iterator
from io import BytesIO
from os import fstat
from typing import Any, BinaryIO, Final, TypeAlias

from mcap.opcode import Opcode
from mcap.records import Chunk, DataEnd, Message
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC as MAGIC

_HEAD: Final = 9
"""Size of opcode and length of a record, before its content [bytes]."""
_NAMED: Final = rb".{36}(?:\x04\0{3}zstd|\x03\0{3}lz4|\0{4})"
"""Beginning of a chunk behind its opcode, up to the name of its compression, with its length."""
_LAYOUT: Final = re.compile(rb"(?s)." + _NAMED + rb"(.{8})")
_BEGINS: Final = re.compile(rb"(?s)\x06(?=" + _NAMED + rb")")
_LONGEST: Final = 53
"""Longest beginning of a chunk, before its data [bytes]."""
_BLOCK: Final = 1 << 20
"""Number of bytes that are read at a time to search for a chunk, or for a checksum."""
_Part: TypeAlias = tuple[list[Any], int, bool]
"""Content of a chunk, or another record; the place behind it; and whether it is a chunk."""
_READ: Final = {Opcode.CHUNK, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.DATA_END}


class SoundRecords:
    """Schemas, channels and messages of an MCAP file, without those in damaged bytes.

    Args:
        file: The file, open for reading.

    Attributes:
        faults: What is damaged, and where, in the order of the file; complete once all was read.
        skipped: Number of bytes that were left out.
        is_mcap: Whether the file begins as MCAP, or a whole chunk was found in it.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._size = fstat(file.fileno()).st_size
        self.is_mcap = self._read(0, len(MAGIC)) == MAGIC
        self.faults = [] if self.is_mcap else ["the first bytes are not those of MCAP"]
        self.skipped = 0
        self._why = ""

    def __iter__(self) -> Iterator[tuple[Any, bool]]:
        """Yield the records in order, and whether each is from a chunk, with its checksum.

        Descriptions in the summary, at the file's end, come first: the first chunk may be damaged.
        """
        yield from self._summary()
        at = sound = len(MAGIC)  # `sound` is the end of the last whole chunk
        chunked = False
        while at < self._size:
            part = self._part_at(at)
            if part is None:
                why, at = self._why, self._next_chunk(sound)
                self.faults.append(f"bytes {sound} to {at} are left out: {why}")
                self.skipped += at - sound
                continue
            records, end, is_chunk = part
            for record in records:
                if isinstance(record, DataEnd):
                    self._compare(at, record.data_section_crc)
                elif is_chunk or not (chunked and isinstance(record, Message)):
                    yield record, is_chunk
            at = end
            if is_chunk:
                sound, self.is_mcap, chunked = at, True, True
        if not (self.faults or self._read(max(self._size, 16) - 8, 8) == MAGIC):
            self.faults.append("the file ends early")

    def _read(self, at: int, count: int) -> bytes:
        """Read bytes from a place on, fewer at the end of the file."""
        self._file.seek(at)
        return self._file.read(count)

    def _summary(self) -> Iterator[tuple[Any, bool]]:
        """Yield schemas and channels of the summary; nothing if the file's end is missing."""
        end = self._read(max(self._size - 37, 0), 37)  # the last record, and the magic bytes
        at = int.from_bytes(end[9:17], "little") if end.endswith(MAGIC) else self._size
        while at < self._size and (part := self._part_at(at)):
            yield from ((each, False) for each in part[0] if hasattr(each, "id"))
            at = part[1]

    def _part_at(self, at: int) -> _Part | None:
        """Return the chunk or record at a place; None if it is damaged, and why in `_why`."""
        self._why = "they are no records"
        head = self._read(at, _LONGEST).ljust(_HEAD, b"\0")
        opcode, end = head[0], at + _HEAD + int.from_bytes(head[1:_HEAD], "little")
        if end > self._size:
            self._why = "the file ends early"
            return None
        layout = _LAYOUT.match(head)
        size = layout and layout.end() + int.from_bytes(layout[1], "little")
        if opcode == 0 or (at + (size or 0) == end) != (opcode == Opcode.CHUNK):
            return None
        if opcode == Opcode.FOOTER:
            return ([], self._size, False) if self._read(end, _LONGEST) == MAGIC else None
        if opcode not in _READ:
            return [], end, False
        try:
            content = BytesIO(self._read(at, end - at))
            record = next(StreamReader(content, skip_magic=True, emit_chunks=True).records)
            is_chunk = isinstance(record, Chunk)
            records = breakup_chunk(record, validate_crc=True) if is_chunk else [record]
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            self._why = str(error) or type(error).__name__
            return None
        return records, end, is_chunk

    def _next_chunk(self, at: int) -> int:
        """Return the place of the first whole chunk from a place on; without, the file's size."""
        places = (
            begin + found.start()
            for begin in range(at, self._size, _BLOCK)
            for found in _BEGINS.finditer(self._read(begin, _BLOCK + _LONGEST))
        )
        parts = ((place, self._part_at(place)) for place in places)
        return next((place for place, part in parts if part and part[2]), self._size)

    def _compare(self, end: int, checksum: int) -> None:
        """Compare the checksum of all bytes before a place with the file's, 0 if it has none."""
        found = 0
        for begin in range(0, end if checksum else 0, _BLOCK):
            found = zlib.crc32(self._read(begin, min(_BLOCK, end - begin)), found)
        if found != checksum and not self.faults:
            self.faults.append("the checksum of all data is another")
