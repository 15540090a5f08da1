# SPDX-License-Identifier: MIT
"""Encode and decode raw samples of any device in an MCAP log.

Raw counts are stored, not angles or forces. These are computed from the counts with the profile,
which can be corrected later.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from mcap.records import Schema

from rig.device import Sample
from rig.sample_columns import SampleColumns, as_columns
from zebro_lab.mcap.cdr import CdrReader, CdrWriter
from zebro_lab.mcap.log_records import Decode, read_log_messages

_TEXT = """\
# Consecutive samples of one device. The metadata of the channel name the counts and their units.
float64[] host_time    # when each was read, since the start of the run [s]
float64[] device_time  # when the device took it, by its own clock; NaN where it tells none [s]
int64[] sequence       # number of each sample, strictly increasing; -1 where it has none
uint32[] status        # status word of the device; 0 where all is well
uint32[] channel       # which of several devices on one link
uint32 width           # counts in each sample
{counts}[] counts      # raw values, sample after sample
"""
COUNTS_NAME = "zebro_lab/msg/RawCounts"
VALUES_NAME = "zebro_lab/msg/RawValues"
RAW_SCHEMAS: dict[str, tuple[str, str]] = {
    COUNTS_NAME: ("<i4", _TEXT.format(counts="int32")),
    VALUES_NAME: ("<f8", _TEXT.format(counts="float64")),
}
"""Type of the counts and text of each schema, by name: whole numbers for almost all devices,
doubles for those whose counts have a fraction."""


@dataclass(frozen=True)
class RawStream:
    """Description of one device's raw samples in a log.

    Attributes:
        schema: Name of the schema of the samples, a key of `RAW_SCHEMAS`.
        metadata: Names and units of the device's counts, so that the log needs no profile.
    """

    schema: str
    metadata: Mapping[str, str]


@dataclass(frozen=True)
class SalvagedStreams:
    """Raw samples of all devices, read from a log that may be damaged.

    Attributes:
        streams: Samples of each device, by topic; host times since the start of the run [s].
        damage: What is damaged, where, and how much is left out; None for a log without damage.
    """

    streams: dict[str, SampleColumns]
    damage: str | None

    @property
    def end(self) -> float | None:
        """Time of the last sample since the start of the run [s]; None without samples."""
        ends = [float(stream.host_time[-1]) for stream in self.streams.values() if len(stream)]
        return max(ends, default=None)


def raw_topic(stream: str) -> str:
    """Return the topic of a stream's raw samples, `/STREAM/raw`."""
    return f"/{stream}/raw"


def encode_raw(samples: Sequence[Sample], *, dtype: str, start: float) -> bytes:
    """Encode samples of one device, at least one, as one CDR message of raw counts.

    Args:
        samples: Samples with equal numbers of counts.
        dtype: NumPy type of the counts in the message, one of those in `RAW_SCHEMAS`.
        start: Host time at which the run began [s]; subtracted from the samples' host times.

    Raises:
        ValueError: The samples differ in their number of counts, or a count is NaN with a `dtype`
            of integers.
        OverflowError: A count is too large for the `dtype`; in `SampleColumns` it wraps instead.
        TypeError: `SampleColumns` hold floats, and `dtype` is one of integers. Fractions of other
            samples are cut off.
    """
    columns = as_columns(samples, dtype)
    message = CdrWriter()
    message.array((columns.host_time - start).astype("<f8"))
    message.array(columns.device_time.astype("<f8")).array(columns.sequence.astype("<i8"))
    message.array(columns.status.astype("<u4")).array(columns.channel.astype("<u4"))
    counts = columns.counts.astype(dtype, casting="same_kind")
    return message.uint32(counts.shape[1]).array(counts.ravel()).message()


def decode_raw(data: bytes, *, dtype: str) -> SampleColumns:
    """Decode a message of `encode_raw` to columns of samples.

    Args:
        data: The message in CDR.
        dtype: NumPy type of the counts in the message, one of those in `RAW_SCHEMAS`.

    Returns:
        The samples; host times since the start of the run [s].

    Raises:
        ValueError: The message is not CDR or truncated, or its sequences differ in length.
    """
    reader = CdrReader(data)
    host, device = reader.array("<f8"), reader.array("<f8")
    sequence, status, channel = reader.array("<i8"), reader.array("<u4"), reader.array("<u4")
    width = reader.uint32()
    counts = reader.array(dtype)
    lengths = {len(part) for part in (host, device, sequence, status, channel)}
    if len(lengths) != 1 or len(counts) != len(host) * width:
        raise ValueError(f"a message has columns of different lengths, not of {len(host)} samples")
    shaped = counts.reshape(len(host), width)
    return SampleColumns(host, device, sequence, status, channel, shaped)


def read_raw_log(path: Path) -> SalvagedStreams:
    """Read the raw samples of all devices from an MCAP log, without what is damaged.

    A message that cannot be decoded, or whose samples have another number of counts than those
    first, counts as damage. Streams without samples are omitted.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or is not MCAP.
    """
    parts: dict[str, list[SampleColumns]] = {}

    def decoder(schema: Schema) -> Decode | None:
        """Return what decodes raw samples; None for other messages."""
        known = RAW_SCHEMAS.get(schema.name)
        return None if known is None else partial(decode_raw, dtype=known[0])

    messages, damage = read_log_messages(path, decoder)
    for topic, _, samples, _ in messages:
        earlier = parts.setdefault(topic, [])
        if earlier and earlier[0].counts.shape[1] != samples.counts.shape[1]:
            damage = f"the number of values per sample of {topic} changes"
        else:
            earlier.append(samples)
    streams = {topic: SampleColumns.joined(found) for topic, found in parts.items()}
    return SalvagedStreams(streams, damage)
