# SPDX-License-Identifier: MIT
r"""Split the recording of a rig that sweeps by itself into sweeps, by jumps of the slip ratio.

After its end a sweep restarts at another slip ratio, and usually at another load. The mean slip
ratio of the `WINDOW` w after an instant less that of the one before it,

.. math::
    d(t) = \bar\kappa(t, t + w) - \bar\kappa(t - w, t) ,

is small while slip glides or climbs stairs, and large where it jumps. Stairs are not cut: the zero
of the load cell is the same on all of them, and only one sweep as a whole can determine it.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.slip.definition import SlipDefinition, slip_ratio

BIN: Final = 0.01
"""Bin over which slip is averaged first: drives report their speeds no more often [s]."""
WINDOW: Final = 0.16
"""Time on either side of a jump that is compared [s]."""
JUMP: Final = 0.3
"""Change of slip ratio larger than any stair of a sweep and smaller than a restart [-]."""
SETTLED: Final = 0.03
"""Change below which a jump is over [-]."""
STANDING: Final = 1e-3
"""Surface speed of the leg disc below which slip is not defined [m/s]."""


def sweeps(time: Array, speed_leg: Array, speed_ground: Array) -> NDArray[np.intp]:
    """Number the sweeps of a recording, which jumps of the slip ratio separate.

    Args:
        time: Time of each sample, increasing, shape (n,) [s].
        speed_leg: Surface speed of the leg disc, shape (n,) [m/s].
        speed_ground: Surface speed of the ground disc, shape (n,) [m/s].

    Returns:
        Index of each sample's sweep from 0 on, non-decreasing but for -1 where slip jumped or the
        leg disc stood, shape (n,).
    """
    index = np.full(len(time), -1, dtype=np.intp)
    turning = np.flatnonzero(np.abs(speed_leg) > STANDING)
    if len(turning) == 0:
        return index
    slip = slip_ratio(speed_leg[turning], speed_ground[turning], SlipDefinition.MATERIAL)
    edges = _bin_edges(time[turning])
    sizes = np.diff(np.append(edges, len(slip)))
    swept = _numbered(~_jumping(np.add.reduceat(slip, edges) / sizes))
    index[turning] = np.repeat(swept, sizes)
    return index


def _bin_edges(time: Array) -> NDArray[np.intp]:
    """Return the index of the first sample of each `BIN` that holds any, shape (bins,)."""
    number = np.floor((time - time[0]) / BIN).astype(np.intp)
    return np.flatnonzero(np.diff(number, prepend=-1))


def _jumping(slip: Array) -> NDArray[np.bool_]:
    """Return whether slip jumps to the next sweep in each bin, shape (bins,).

    A jump is a stretch of bins with |d| > `SETTLED`, and |d| > `JUMP` in one of them, where d is
    the mean slip of the `WINDOW` after a bin less that of the one before it. Where the recording is
    shorter than two `WINDOW`, there are no jumps.

    Args:
        slip: Mean slip ratio of each bin, shape (bins,) [-].
    """
    w = round(WINDOW / BIN)
    jumping = np.zeros(len(slip), dtype=bool)
    if len(slip) < 2 * w:
        return jumping
    total = np.concatenate([[0.0], np.cumsum(slip)])
    d = np.abs(total[2 * w :] - 2 * total[w:-w] + total[: -2 * w]) / w  # d[i] belongs to bin i + w
    for begin, end in _stretches(d > SETTLED):
        if d[begin:end].max() > JUMP:
            # d rises above SETTLED w bins before the jump, as soon as the jump enters the window
            # ahead; the sweep before is cut only from w / 2 bins before the jump on.
            first = min(begin + w, end) + w // 2 if begin > 0 else 0
            jumping[first : end + w if end < len(d) else None] = True
    return jumping


def _numbered(swept: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Number the stretches of true values from 0 on, -1 where false, shape (bins,)."""
    index = np.full(len(swept), -1, dtype=np.intp)
    for number, (begin, end) in enumerate(_stretches(swept)):
        index[begin:end] = number
    return index


def _stretches(true: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """List the stretches of true values in order, each as (first index, last index + 1)."""
    edges = np.flatnonzero(np.diff(true, prepend=False, append=False))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
