# SPDX-License-Identifier: MIT
r"""Length and direction of travel of a path that was measured, with noise and at any rate.

Straight lines through all poses add up the noise: 0.3 mm at 120 Hz lengthen a walk of 1.4 m by
0.5 m, and between two neighbours the direction is that of the noise. Here a pose counts once the
path has moved on by a chord from the last pose that counted, and lines join the poses that count.
The chord is

.. math::
    c = \max(30\,\sigma, e / 50)

with :math:`\sigma` the noise of the positions, estimated from the path itself, and e the path's
extent. Noise across a line lengthens it by :math:`\sigma^2 / c^2` of its length, so by about a
thousandth at most; a chord shortens a circle of radius R by :math:`c^2 / 24 R^2` of its length.

Of poses far apart, as in photographs, no polynomial follows the motion, and most of what looks like
noise is motion: 30 times it would drop poses that are needed. Noise that lengthens a path lies
across it. Where neighbours are usually :math:`10\,\sigma_\perp` apart or more, with
:math:`\sigma_\perp` what lies across the way, lines through all poses are too long by a hundredth
at most, and half the usual distance is enough in place of :math:`30\,\sigma`. It is not where
neighbours are within :math:`2\,\sigma`, as then their distance is the noise along the way. Below
about five poses a turn, motion cannot be told from noise.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from model.arrays import Array
from model.poses import Poses, wrap

STANDING = 1e-6  # m: between poses closer than this there is no direction of travel
_NOISES = 30.0  # chord in standard deviations of the noise
_PARTS = 50  # of the extent; smaller moves, as noise that hangs together in time, are no travel
_WINDOW = 5  # poses through which a cubic would pass without noise
_WIDE = 9  # the same of a polynomial of seventh order, from about five poses a turn on
# Usual distance of neighbours from which poses are far apart: in standard deviations of what lies
# across the way, which then lengthens lines by a hundredth; and in those of all noise, which alone
# puts neighbours 1.7 apart.
_CLEAR_OF_NOISE = 10.0
_MOVING = 2.0
_CLEAR = np.radians(20.0)  # least turn of a path whose side neither noise nor sway can reverse
_ALIKE = 3.0  # ratio of the curvatures of two paths that may be mirror images
_RAYLEIGH = np.sqrt(2 * np.log(2))  # median length of a vector of two standard normal numbers
_HALF_NORMAL = 0.6745  # median size of a standard normal number


def position_noise(poses: Poses) -> float:
    r"""Estimate the standard deviation of the noise of x and of y from one path alone [m].

    Of five poses in a row the divided difference of fourth order is taken, which is zero for any
    motion that is cubic in time, at times however uneven,

    .. math::
        d = \frac{\sum_j w_j p_j}{\sqrt{\sum_j w_j^2}}, \qquad
        w_j = \prod_{k \ne j} \frac{1}{t_j - t_k} .

    For independent noise its components have the noise's standard deviation, and its length is
    distributed as Rayleigh's; the median over the path is not led astray by single jumps.

    Args:
        poses: One path.

    Returns:
        The noise, with what of the motion no cubic follows; 0 for fewer than five poses.
    """
    if len(poses) < _WINDOW:
        return 0.0
    return float(np.median(np.linalg.norm(_differences(poses, _WINDOW), axis=1)) / _RAYLEIGH)


def travel_chord(poses: Poses) -> float:
    """Compute the chord by which one path moves on from pose to pose that counts [m].

    The extent is twice the largest distance of a position from their mean.
    """
    if len(poses) == 0:
        return 0.0
    away = np.linalg.norm(poses.position - poses.position.mean(axis=0), axis=1)
    return max(_noise_chord(poses), 2 * float(away.max()) / _PARTS)


def travelled(poses: Poses, *, chord: float | None = None) -> Array:
    """Compute the distance travelled up to each pose of one path, shape (n,) [m].

    A pose counts if it is a chord from the last that counted; lines join the poses that count.
    Between them it is how far the pose has come along the line, and never less than at the pose
    before.

    Args:
        poses: The path.
        chord: Chord between poses that count [m]; None for that of the path.
    """
    if len(poses) < 2:
        return np.zeros(len(poses))
    counted = _counted(poses, travel_chord(poses) if chord is None else chord)
    corners = poses.position[counted]
    lines = np.diff(corners, axis=0)
    lengths = np.linalg.norm(lines, axis=1)
    before = np.concatenate([[0.0], np.cumsum(lengths)])
    on = np.minimum(np.searchsorted(counted, np.arange(len(poses)), side="right"), len(lines)) - 1
    unit = lines / np.where(lengths > 0, lengths, 1.0)[:, None]
    along = np.einsum("nk,nk->n", poses.position - corners[on], unit[on])
    way = before[on] + np.clip(along, 0.0, lengths[on])
    way[counted] = before
    return np.maximum.accumulate(way)


def path_length(poses: Poses, *, chord: float | None = None) -> float:
    """Compute the length of one path; 0 with fewer than two poses [m].

    Args:
        poses: The path.
        chord: Chord between poses that count [m]; None for that of the path.
    """
    return float(travelled(poses, chord=chord)[-1]) if len(poses) else 0.0


def has_travelled(poses: Poses) -> bool:
    """Return whether one path moves on by its chord: else what moves may be its noise alone."""
    return path_length(poses) >= travel_chord(poses) > 0


def travel_direction(poses: Poses) -> Array:
    """Compute the direction of travel at each pose of one path, shape (n,) [rad].

    A pose counts if it is a chord (`travel_chord`) from the last that counted. The direction is
    that from the last pose before that counts to the next that counts; at the ends one of the two
    is the pose itself. Where they are within `STANDING`, the last direction before is repeated, or
    the first after; zero if the robot never moves.
    """
    if len(poses) < 2:
        return np.zeros(len(poses))
    counted = _counted(poses, travel_chord(poses))
    here, last = np.arange(len(poses)), len(counted) - 1
    before = counted[np.maximum(np.searchsorted(counted, here, side="left") - 1, 0)]
    after = counted[np.minimum(np.searchsorted(counted, here, side="right"), last)]
    chord = poses.position[after] - poses.position[before]
    moving = np.flatnonzero(np.linalg.norm(chord, axis=1) > STANDING)
    if len(moving) == 0:
        return np.zeros(len(poses))
    known = moving[np.maximum(np.searchsorted(moving, here, side="right") - 1, 0)]
    return np.arctan2(chord[known, 1], chord[known, 0])


def travel_turn(poses: Poses) -> float:
    """Compute by how much the direction of travel of one path turns in all, positive left [rad].

    It is summed over the lines between poses that count. A reversal, by more than a right angle, is
    no turn to either side; 0 for a path that does not move on.
    """
    if not has_travelled(poses):
        return 0.0
    x, y = np.diff(poses.position[_counted(poses, travel_chord(poses))], axis=0).T
    turns = wrap(np.diff(np.arctan2(y, x)))
    return float(turns[np.abs(turns) < np.pi / 2].sum())


def turn_oppositely(first: Poses, second: Poses) -> bool:
    """Return whether two paths clearly turn to opposite sides, by about the same curvature.

    So do a path and its mirror image. Each must turn by `_CLEAR` or more, and turns over length may
    differ by a factor of `_ALIKE`; they need not be of the same length or by the same clock.
    """
    turns = travel_turn(first), travel_turn(second)
    if min(map(abs, turns)) < _CLEAR or turns[0] * turns[1] > 0:
        return False
    curvatures = [abs(t) / path_length(p) for t, p in zip(turns, (first, second), strict=True)]
    return max(curvatures) < _ALIKE * min(curvatures)


def _noise_chord(poses: Poses) -> float:
    """Compute the chord that noise requires: 30 standard deviations, or less for sparse poses [m].

    Where poses are far apart (see the module), half the usual distance is enough. 0 without noise.
    """
    noise = position_noise(poses)
    if noise == 0:
        return 0.0
    usual = float(np.median(np.linalg.norm(np.diff(poses.position, axis=0), axis=1)))
    far = usual >= max(_CLEAR_OF_NOISE * _noise_across(poses), _MOVING * noise)
    return min(_NOISES * noise, usual / 2) if far else _NOISES * noise


def _noise_across(poses: Poses) -> float:
    """Return the standard deviation of what lies across the way; 0 for fewer than nine poses [m].

    Across is to the line through the neighbours of each middle pose, so that a robot that slows
    down and speeds up between poses adds little.
    """
    if len(poses) < _WIDE:
        return 0.0
    line = (poses.position[2:] - poses.position[:-2])[_WIDE // 2 - 1 : 1 - _WIDE // 2]
    rest = _differences(poses, _WIDE)
    length = np.linalg.norm(line, axis=1)
    across = (rest[:, 0] * line[:, 1] - rest[:, 1] * line[:, 0]) / np.where(length > 0, length, 1.0)
    return float(np.median(np.abs(across)) / _HALF_NORMAL)


def _differences(poses: Poses, window: int) -> Array:
    """Return the divided differences of `window` poses in a row, shape (n - window + 1, 2) [m]."""
    t = sliding_window_view(poses.t, window)
    apart = (t[:, :, None] - t[:, None, :]) / np.ptp(t, axis=1)[:, None, None]
    weight = 1 / (apart + np.eye(window)).prod(axis=2)
    weight /= np.linalg.norm(weight, axis=1, keepdims=True)
    return np.einsum("nj,nkj->nk", weight, sliding_window_view(poses.position, window, axis=0))


def _counted(poses: Poses, chord: float) -> NDArray[np.intp]:
    """Return the increasing indices of the poses that count, the first and the last among them.

    A pose counts if it is a chord [m] or more from the last one that counted; with a chord of zero,
    if it is in another place. The last pose takes the place of the one that counted last if it is
    within the chord of it, so that a robot that stands at the end adds no line of noise.
    """
    places = (poses.position[:, 0] + 1j * poses.position[:, 1]).tolist()
    counted, corner = [0], places[0]
    for index, place in enumerate(places):
        if abs(place - corner) >= chord > 0 or (chord == 0 and place != corner):
            counted.append(index)
            corner = place
    last = len(places) - 1
    if len(counted) > 1 and counted[-1] != last:
        counted.pop()
    if counted[-1] != last:
        counted.append(last)
    return np.array(counted)
