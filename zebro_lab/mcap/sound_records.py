# SPDX-License-Identifier: MIT
"""Read the records of an MCAP file, also behind damaged bytes: from the next whole chunk on.

The readers of the library `mcap` end at the first damage, or need the index at the end, which a
truncated file has lost. A chunk is found by the name of its compression, at a fixed place in it,
and proved by its checksum.
"""

import re
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from io import BytesIO
from os import fstat
from typing import BinaryIO, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, DataEnd, McapRecord, Message, Schema
from mcap.stream_reader import breakup_chunk
from mcap.writer import MCAP0_MAGIC as MAGIC

_RECORD: Final = struct.Struct("<BQ")
"""Opcode and length of a record, before its content."""
_CHUNK: Final = struct.Struct("<BQQQQII")
"""Beginning of a chunk: opcode, length, two times, unpacked size, checksum, length of a name."""
_COUNT: Final = struct.Struct("<Q")
_COMPRESSIONS: Final = (b"zstd", b"lz4", b"")
_NAMED: Final = re.compile(rb"(?s)\x04\0{3}zstd|\x03\0{3}lz4|\x06.{36}\0{4}")
"""Name of a compression with its length; or the beginning of a chunk that is not compressed."""
_BEFORE_NAME: Final = 37
_LONGEST: Final = _CHUNK.size + 4 + _COUNT.size
"""Longest beginning of a chunk, before its data [bytes]."""
_BLOCK: Final = 1 << 20
"""Number of bytes that are read at a time to search for a chunk, or for a checksum."""
_READ: Final[Mapping[int, Callable[[ReadDataStream, int], McapRecord]]] = {
    Opcode.SCHEMA: lambda content, _: Schema.read(content),
    Opcode.CHANNEL: lambda content, _: Channel.read(content),
    Opcode.MESSAGE: Message.read,
    Opcode.DATA_END: lambda content, _: DataEnd.read(content),
}
"""Reads the content of a record outside chunks, by opcode."""
_FOOTER: Final = _RECORD.size + 20 + len(MAGIC)
"""Size of the end of a file, from the last record on [bytes]."""


class _Part(NamedTuple):
    """Chunk, or another record, with the place behind it.

    Attributes:
        records: Schemas, channels and messages of it.
        end: Place of the next record.
        is_chunk: Whether it is a chunk.
    """

    records: list[McapRecord]
    end: int
    is_chunk: bool


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
        self._ended = self._chunked = False

    def __iter__(self) -> Iterator[tuple[McapRecord, bool]]:
        """Yield the records in order, and whether each is from a chunk, with its checksum.

        Descriptions in the summary, at the file's end, come first: the first chunk may be damaged.
        """
        yield from self._summary()
        self._ended = False
        at = sound = len(MAGIC)  # `sound` is the end of the last whole chunk
        while at < self._size:
            self._why = "bytes are damaged"
            part = self._chunk_at(at) or self._record_at(at)
            if part is None:
                self.faults.append(f"{self._why} at byte {at}")
                at = self._next_chunk(sound)
                self.skipped += at - sound
                continue
            for record in part.records:
                if isinstance(record, DataEnd):
                    self._compare(at, record.data_section_crc)
                yield record, part.is_chunk
            at = part.end
            if part.is_chunk:
                sound, self.is_mcap, self._chunked = at, True, True
        if not (self._ended or self.faults):
            self.faults.append("the file ends early")

    def _read(self, at: int, count: int) -> bytes:
        """Read bytes from a place on, fewer at the end of the file."""
        self._file.seek(at)
        return self._file.read(count)

    def _summary(self) -> Iterator[tuple[McapRecord, bool]]:
        """Yield schemas and channels of the summary; nothing if the file's end is damaged."""
        end = self._read(max(self._size - _FOOTER, 0), _FOOTER)
        if len(end) < _FOOTER or not end.endswith(MAGIC):
            return
        (at,) = _COUNT.unpack_from(end, _RECORD.size)
        while 0 < at < self._size and (part := self._record_at(at)) is not None:
            yield from ((r, False) for r in part.records if isinstance(r, Schema | Channel))
            at = part.end

    def _chunk_at(self, at: int) -> _Part | None:
        """Return the whole chunk at a place, whose opcode alone may be damaged; else None."""
        head = self._read(at, _LONGEST)
        if len(head) < _LONGEST:
            return None
        opcode, length, _, _, _, checksum, named = _CHUNK.unpack_from(head)
        behind = _CHUNK.size + min(named, 4)
        if head[_CHUNK.size : behind] not in _COMPRESSIONS or named > 4:
            return None
        end = at + behind + _COUNT.size + _COUNT.unpack_from(head, behind)[0]
        # The data may go on behind what is unpacked: one of two lengths that differ is damaged.
        if end != at + _RECORD.size + length or end > self._size:
            return None
        if opcode != Opcode.CHUNK and not (checksum and named):
            return None
        content = self._read(at + _RECORD.size, end - at - _RECORD.size)
        try:
            chunk = Chunk.read(ReadDataStream(BytesIO(content)))
            return _Part(breakup_chunk(chunk, validate_crc=True), end, is_chunk=True)
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            self._why = f"a chunk is damaged ({str(error) or type(error).__name__})"
            return None

    def _record_at(self, at: int) -> _Part | None:
        """Return the record at a place that is not a chunk; None if it is damaged or a chunk."""
        head = self._read(at, _RECORD.size).ljust(_RECORD.size, b"\0")
        opcode, length = _RECORD.unpack(head)
        end = at + _RECORD.size + length
        if end > self._size:
            self._why = "the file ends early"
        if opcode in (0, Opcode.CHUNK) or end > self._size:
            return None
        if opcode == Opcode.FOOTER:
            self._ended = self._read(end, len(MAGIC) + 1) == MAGIC
            return _Part([], self._size, is_chunk=False) if self._ended else None
        if opcode not in _READ or (opcode == Opcode.MESSAGE and self._chunked):
            return _Part([], end, is_chunk=False)
        content = ReadDataStream(BytesIO(self._read(at + _RECORD.size, length)))
        try:
            return _Part([_READ[opcode](content, length)], end, is_chunk=False)
        except Exception:  # as above
            return None

    def _next_chunk(self, at: int) -> int:
        """Return the place of the first whole chunk from a place on; without, the file's size."""
        for begin in range(at, self._size, _BLOCK):
            block = self._read(begin, _BLOCK + _LONGEST)
            found = _NAMED.search(block)
            while found is not None:
                ahead = 0 if found[0].startswith(b"\6") else _BEFORE_NAME
                if found.start() >= ahead and self._chunk_at(begin + found.start() - ahead):
                    return begin + found.start() - ahead
                found = _NAMED.search(block, found.start() + 1)
        return self._size

    def _compare(self, end: int, checksum: int) -> None:
        """Compare the checksum of all bytes before a place with the file's, 0 if it has none."""
        found = 0
        for begin in range(0, end if checksum else 0, _BLOCK):
            found = zlib.crc32(self._read(begin, min(_BLOCK, end - begin)), found)
        if found != checksum and not self.faults:
            self.faults.append("the checksum of all data is another")
