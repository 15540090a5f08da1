# SPDX-License-Identifier: MIT
"""Stream the records of an MCAP log, with limits on the size of decompressed chunks.

The seeking reader is not used: it needs the index at the end, which a truncated file has lost.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.files.opening import open_file

if TYPE_CHECKING:
    from mcap.records import Chunk, McapRecord

MOST_CHUNK: Final = 64 << 20
"""Largest chunk that is decompressed; recorders write chunks of about 1 MiB [bytes]."""
FREELY: Final = 64 << 20
"""Decompressed size allowed to every log, however small its file [bytes]."""
MOST_RATIO: Final = 100
"""Decompressed size allowed beyond `FREELY`, per size of the file [-]; sensor data stay below."""
_WIDEST_WINDOW: Final = 1 << 27  # memory that a zstd frame may ask for while it is unpacked


def read_records(path: Path, take: "Callable[[McapRecord], object]") -> str | None:
    """Pass each record of an MCAP log to a function, up to the first damage.

    A missing end, a wrong checksum, an unknown compression and a chunk that would unpack to more
    than the limits count as damage, too; so does an exception in `take`.

    Args:
        path: The log.
        take: Called with each record, with those inside a chunk instead of the chunk.

    Returns:
        Why reading stopped before the end; None for a log read to its end.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or does not begin (or, though it is
            complete, end) with the magic bytes of MCAP.
        ZebroLabError: `take` raised it.
    """
    from mcap.exceptions import InvalidMagic
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, breakup_chunk

    with open_file(path) as file:
        size = os.fstat(file.fileno()).st_size
        left = FREELY + MOST_RATIO * size
        reader = StreamReader(
            file, emit_chunks=True, validate_crcs=True, record_size_limit=max(size, 1)
        )
        try:
            for record in reader.records:
                if isinstance(record, Chunk):
                    unpacked = _unpacked(record, min(left, MOST_CHUNK))
                    left -= len(unpacked.data)
                    for inner in breakup_chunk(unpacked, validate_crc=True):
                        take(inner)
                else:
                    take(record)
        except InvalidMagic as error:
            raise DataError("is not an MCAP file", file=path) from error
        except ZebroLabError:
            raise
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            return str(error) or "the file ends early"  # as the reader's EndOfFile, without words
    return None


def _unpacked(chunk: "Chunk", most: int) -> "Chunk":
    """Decompress a chunk (zstd or lz4) of at most `most` bytes; return an uncompressed one as is.

    Raises:
        ValueError: The chunk claims more than `most` bytes unpacked, or holds more than it claims.
        KeyError: The compression is unknown.
        Exception: Any other, by the libraries: the packed data are damaged.
    """
    if chunk.compression == "":
        return chunk
    if chunk.uncompressed_size > most:
        raise ValueError(
            f"a chunk would unpack to {chunk.uncompressed_size} bytes, expected at most {most}"
        )
    data = _UNPACK[chunk.compression](chunk.data, chunk.uncompressed_size + 1)
    if len(data) > chunk.uncompressed_size:
        raise ValueError("a chunk unpacks to more bytes than its header states")
    return replace(chunk, compression="", data=data)


def _zstd(data: bytes, most: int) -> bytes:
    import zstandard

    decompressor = zstandard.ZstdDecompressor(max_window_size=_WIDEST_WINDOW)
    with decompressor.stream_reader(data) as reader:
        return reader.read(most)


def _lz4(data: bytes, most: int) -> bytes:
    import lz4.frame

    return lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most)


_UNPACK: "Final[dict[str, Callable[[bytes, int], bytes]]]" = {"zstd": _zstd, "lz4": _lz4}
