# SPDX-License-Identifier: MIT
"""Samples of one stream as columns (structure of arrays), for vectorised processing."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Self, overload

import numpy as np
from numpy.typing import DTypeLike, NDArray

from model.arrays import Array
from rig.device import Sample


@dataclass(frozen=True, eq=False)
class SampleColumns(Sequence[Sample]):
    """Samples in order, one array for each field; behaves as a sequence of `Sample`.

    Attributes:
        host_time: Time at which each sample was read, shape (n,) [s].
        device_time: Time by the device's clock, NaN where it sends none, shape (n,) [s].
        sequence: Sequence number of each sample, -1 where it has none, shape (n,).
        status: Status words, shape (n,).
        channel: Index of the device among several on the link, 0 for a single one, shape (n,).
        counts: Raw values of each sample, shape (n, counts of a sample).
    """

    host_time: Array
    device_time: Array
    sequence: NDArray[np.int64]
    status: NDArray[np.uint32]
    channel: NDArray[np.uint32]
    counts: NDArray[Any]

    @classmethod
    def joined(cls, parts: Sequence[Self]) -> Self:
        """Concatenate parts of one stream in the given order; there must be at least one part."""
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return parts[0] if len(parts) == 1 else cls(*map(np.concatenate, columns))

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.host_time)

    def __iter__(self) -> Iterator[Sample]:
        """Yield the samples one by one."""
        columns = (column.tolist() for column in vars(self).values())
        for row in zip(*columns, strict=True):
            yield _sample(*row)

    @overload
    def __getitem__(self, index: int) -> Sample: ...
    @overload
    def __getitem__(self, index: slice) -> Self: ...
    def __getitem__(self, index: int | slice) -> "Sample | Self":
        """Return one sample for an index, or the columns of the samples in a slice."""
        if isinstance(index, slice):
            return type(self)(*(column[index] for column in vars(self).values()))
        return _sample(*(column[index].tolist() for column in vars(self).values()))


def _sample(
    host: float, device: float, number: int, status: int, channel: int, counts: list[float]
) -> Sample:
    """Build the sample of one row; a NaN device time and a negative number become None."""
    time = None if math.isnan(device) else device
    return Sample(host, time, None if number < 0 else number, tuple(counts), status, channel)


def as_columns(samples: Sequence[Sample], dtype: DTypeLike = float) -> SampleColumns:
    """Convert samples to columns; columns are returned unchanged.

    Without samples every column is empty, and the counts have the shape (0,).

    Args:
        samples: Samples of one stream, with equal numbers of counts.
        dtype: Type of the counts; not applied to columns.

    Raises:
        ValueError: The samples differ in their number of counts.
        OverflowError: A count does not fit into `dtype`.
    """
    if isinstance(samples, SampleColumns):
        return samples
    fields = tuple(zip(*samples, strict=True)) or ((),) * len(Sample._fields)
    host, device, sequence, counts, status, channel = fields
    return SampleColumns(
        host_time=np.array(host, dtype=float),
        device_time=np.array(device, dtype=float),  # None becomes NaN
        sequence=np.array([-1 if n is None else n for n in sequence], dtype=np.int64),
        status=np.array(status, dtype=np.uint32),
        channel=np.array(channel, dtype=np.uint32),
        counts=np.array(counts, dtype=dtype),
    )
