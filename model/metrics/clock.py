# SPDX-License-Identifier: MIT
"""Estimate the clock offset between a track and a path from the motion alone.

Starts, stops and turns determine it. Uniform motion does not, because a later clock is then
equivalent to a starting point further back, which is unknown too.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import InsufficientData
from model.poses import Poses
from model.travel import travelled

STEP = 0.05  # s between offsets that are tried; refined by a parabola
FEWEST = 6  # least number of poses of a track
BLOCKS = 5  # blocks of consecutive poses of the track that are left out in turn
SHARE = 0.5  # of the track's poses and of its length that must lie within the path
LARGEST_SD = 0.25  # s; a less certain estimate is refused
# Ratio to the least misfit below which another offset fits as well: the 99 % quantile of F, with
# two degrees of freedom for each block in numerator and denominator.
AS_GOOD = 5.0
NEAR = 7.0  # standard deviations from the best offset within which an offset is no rival


@dataclass(frozen=True)
class ClockOffset:
    """Offset to add to a track's times to convert them to a path's clock.

    Attributes:
        value: The offset [s].
        sd: Standard deviation of the offset [s].
    """

    value: float
    sd: float


def estimate_offset(track: Poses, path: Poses) -> ClockOffset:
    r"""Estimate the clock offset at which the path, moved, turned and scaled, fits the track best.

    .. math::
        \hat\tau = \arg\min_\tau \min_{s, R, p}
            \frac{1}{2 n_\tau - 4} \sum_i |s R\,x(t_i + \tau) + p - y_i|^2

    over the :math:`n_\tau` tracked positions :math:`y_i` whose shifted times lie within those of
    the path x, with scale s, rotation R and shift p. The scale absorbs a wrong speed, which would
    otherwise appear as a clock offset. The standard deviation is the larger of two: by least
    squares with two independent errors in each of `BLOCKS` blocks of consecutive poses, since
    errors of a predicted path are correlated in time, and by the jackknife over these blocks.

    Args:
        track: The track, six poses or more.
        path: The path, sampled densely.

    Raises:
        InsufficientData: There are fewer than six poses, no offset brings four of them and half of
            the track (poses and length) within the path's times, the best offset is the first or
            last tried (half the path's duration either side of common middles), its standard
            deviation is `LARGEST_SD` or more, or another offset, over `NEAR` standard deviations
            plus 0.1 s away and with as many poses within or more, has a misfit below `AS_GOOD`
            times the least.
    """
    if len(track) < FEWEST:
        raise InsufficientData(
            f"{len(track)} tracked poses cannot determine the clock offset; {FEWEST} are needed"
        )
    offsets = _possible(track, path)
    way = travelled(track)
    misfit = np.array([_misfit(track, path, each, way=way) for each in offsets])
    best = int(np.argmin(misfit))
    if not np.isfinite(misfit[best]) or best in (0, len(offsets) - 1):
        raise InsufficientData(
            f"no clock offset puts {SHARE:.0%} of the track and four poses within the path's time, "
            "or the best is the first or last that was tried; give the offset"
        )
    value, curvature = _parabola(offsets, misfit, best)
    near = value + np.arange(-1.0, 1.0 + STEP, STEP)
    at = track.t + value
    inside = track.part((at >= path.t[0]) & (at <= path.t[-1]))
    sd = max(_sd_of_fit(misfit[best], curvature), _sd_of_blocks(inside, path, near))
    if not sd < LARGEST_SD:
        raise InsufficientData(
            f"the motion determines the clock offset only to {sd:.2g} s (limit {LARGEST_SD:g} s); "
            "let the robot start and stop in view, or give the offset"
        )
    at = track.t + offsets[:, None]
    held = ((at >= path.t[0]) & (at <= path.t[-1])).sum(axis=1)
    rivals = (np.abs(offsets - value) > NEAR * sd + 2 * STEP) & (held >= held[best])
    _require_one(offsets[rivals], misfit[rivals], value, misfit[best])
    return ClockOffset(value, sd)


def _require_one(offsets: Array, misfit: Array, value: float, least: float) -> None:
    """Raise `InsufficientData` if a rival offset's misfit is below `AS_GOOD` times the least.

    Photographs every two seconds can miss whole strides.

    Args:
        offsets: Rival offsets away from the best, with at least as many poses within the path [s].
        misfit: Misfit at each rival offset [m2].
        value: The best offset [s].
        least: Misfit at the best offset [m2].
    """
    if len(misfit) and misfit.min() < AS_GOOD * least:
        other = offsets[int(np.argmin(misfit))]
        raise InsufficientData(
            f"the motion fits about as well with {other:+.1f} s added to the track's times as with "
            f"{value:+.1f} s, as strides do that repeat; let the robot start and stop in view, or "
            "give the offset"
        )


def _possible(track: Poses, path: Poses) -> Array:
    """Return offsets, `STEP` apart, that put the track's middle time within the path's [s]."""
    middle = 0.5 * (track.t[0] + track.t[-1])
    reach = 0.5 * (path.t[-1] - path.t[0])
    return 0.5 * (path.t[0] + path.t[-1]) - middle + np.arange(-reach, reach + STEP, STEP)


def _misfit(track: Poses, path: Poses, offset: float, *, way: Array | None = None) -> float:
    """Compute the misfit at an offset: squared distances over their degrees of freedom [m2].

    The distances are those that remain when the path is moved, turned and scaled to fit. Infinite
    if fewer than four poses lie within the path's times, or less than `SHARE` of the track's poses
    or of `way`, the distance travelled up to each of them, shape (n,) [m]; without `way`, if not
    all poses do.
    """
    at = track.t + offset
    inside = (at >= path.t[0]) & (at <= path.t[-1])
    seen = track.part(inside)
    if len(seen) < 4 or not _enough(inside, way):
        return np.inf
    x, y = _centred(path.at(at[inside])), _centred(seen)
    moving = float(np.abs(x * x.conj()).sum())
    shared = np.abs((y * x.conj()).sum()) ** 2 / moving if moving > 0 else 0.0
    left = max(float((np.abs(y) ** 2).sum() - shared), 0.0)  # rounding may make it negative
    return left / (2 * len(seen) - 4)


def _enough(inside: NDArray[np.bool_], way: Array | None) -> bool:
    """Return whether `SHARE` of the poses and of the distance travelled `way` [m] are inside.

    Without `way`, whether all poses are.
    """
    if way is None:
        return bool(inside.all())
    return bool(inside.mean() >= SHARE and np.ptp(way[inside]) >= SHARE * way[-1])


def _centred(poses: Poses) -> NDArray[np.complex128]:
    """Return positions x + iy of one path minus their mean, shape (n,) [m]."""
    place = poses.position[:, 0] + 1j * poses.position[:, 1]
    return place - place.mean()


def _parabola(offsets: Array, misfit: Array, best: int) -> tuple[float, float]:
    """Fit a parabola at the least misfit; return its minimum [s] and second derivative [m2/s2].

    It passes through the misfits [m2] at index `best` and its two neighbours. Without a finite
    positive second derivative the offset at `best` and zero are returned.
    """
    before, here, after = misfit[best - 1 : best + 2]
    second = (before - 2 * here + after) / STEP**2
    if not (np.isfinite(second) and second > 0):
        return float(offsets[best]), 0.0
    return float(offsets[best] - 0.5 * (after - before) / STEP / second), float(second)


def _sd_of_fit(misfit: float, curvature: float) -> float:
    """Compute the offset's standard deviation by least squares with two errors a block [s].

    From the least misfit [m2] and its second derivative `curvature` [m2/s2]; infinite if that is
    not positive.
    """
    return float(np.sqrt(2 * misfit / (2 * BLOCKS * curvature))) if curvature > 0 else np.inf


def _sd_of_blocks(track: Poses, path: Poses, offsets: Array) -> float:
    """Compute the jackknife's standard deviation of the offset, leaving out each block [s].

    Infinite if without some block the least misfit is at either end of `offsets` [s], as when no
    offset keeps all other poses of the track within the path's times.
    """
    found = []
    for block in np.array_split(np.arange(len(track)), BLOCKS):
        rest = track.part(np.delete(np.arange(len(track)), block))
        # With all poses inside: one that leaves the path's time would no longer add to the misfit.
        misfit = np.array([_misfit(rest, path, each) for each in offsets])
        best = int(np.argmin(misfit))
        if best in (0, len(offsets) - 1):
            return np.inf
        found.append(_parabola(offsets, misfit, best)[0])
    spread = np.array(found) - np.mean(found)
    return float(np.sqrt((BLOCKS - 1) / BLOCKS * (spread**2).sum()))
