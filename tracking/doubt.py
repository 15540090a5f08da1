# SPDX-License-Identifier: MIT
r"""Which stated value of the robot does not fit a track: alternatives in which one is far off.

With u the shared errors, independent and of variance 1, the photographs give them a likelihood
:math:`\exp(-u^T D u / 2 + b^T u)`, poses eliminated. An alternative adds an error of f stated
standard deviations of one value, along W: u then has the covariance
:math:`\Sigma = 1 + f^2\, W W^T`, and the log odds are those of the marginal likelihoods

.. math::
    -\tfrac12 \log |1 + \Sigma D| + \tfrac12 b^T (\Sigma^{-1} + D)^{-1} b .
"""

import numpy as np

from model.arrays import Array
from tracking.floor.doubt import SuspectValue, more_or_less
from tracking.path import Track
from tracking.shared import HEIGHT, SIDE, TILT

REMARKABLE = 1.2
"""Log odds from which a stated value of the robot is suspected [-].

Of 160 simulated sound walks two reach it, of 40 others two
(`benchmarks.accuracy.planted_track_faults` at the tag `full-toolkit`). There are fewer alternatives
than of the floor, so that chance lifts the highest of them less."""

_BACKWARDS = np.radians(120)  # from the heading, above which a robot moves backwards
_SIDEWAYS = np.radians(40)  # from which to there it moves sideways
_STRAY = 0.05  # m, travelled less than which a walk has no direction

_FAR = {SIDE: (8.0, 32.0, 128.0), HEIGHT: (8.0,), TILT: (8.0,)}
"""By cause, how far off it may be, in stated standard deviations; of several the mean counts.

Another print, or another square of it, may have any side; a height is misread by centimetres."""

_WORDS = {
    SIDE: ("the side of the robot's marker (robot.toml)", " mm", 1e3),
    HEIGHT: ("the height of the body (marker.height in robot.toml, --body-height)", " mm", 1e3),
    TILT: ("the tilt of the robot's marker", " degrees", float(np.degrees(1))),
}


def doubts(track: Track) -> tuple[SuspectValue, ...]:
    """Compare alternatives in which the marker's side, the body's height or tilt is far off.

    Args:
        track: The track, with the errors that were stated.

    Returns:
        One suspect for each of the three that was stated, and not as exact.
    """
    stated, path = track.stated, track.smoothed
    root = stated.root
    r = root.shape[1]
    normal = np.linalg.inv(path.shared_covariance)
    D, b = normal - np.eye(r), normal @ path.shared
    plain = _log_likelihood(D, b, np.eye(r))[0]
    found = []
    for cause, (what, unit, scale) in _WORDS.items():
        if cause not in stated.slots:
            continue
        slot = stated.slots[cause]
        sd = np.sqrt(np.diag(stated.covariance)[slot])
        if not np.all(sd > 0):
            continue  # taken as exact
        axes = np.zeros((stated.size, len(sd)))
        axes[slot] = np.diag(sd)
        W = np.linalg.pinv(root) @ axes
        tried = [_log_likelihood(D, b, np.eye(r) + far**2 * W @ W.T) for far in _FAR[cause]]
        log_likelihood, u = max(tried, key=lambda each: each[0])
        mean = log_likelihood + np.log(np.mean(np.exp([log - log_likelihood for log, _ in tried])))
        off = (root @ u)[slot] * scale
        finding = " and ".join(more_or_less(float(each), unit) for each in off)
        found.append(SuspectValue(what, finding, float(mean) - plain))
    return tuple(found)


def _log_likelihood(D: Array, b: Array, covariance: Array) -> tuple[float, Array]:
    """Compute the log marginal likelihood for a covariance of u, and the estimate of u."""
    u = np.linalg.solve(np.linalg.inv(covariance) + D, b)
    log_det = float(np.linalg.slogdet(np.eye(len(b)) + covariance @ D)[1])
    return 0.5 * (float(b @ u) - log_det), u


def heading_doubts(track: Track) -> tuple[str, ...]:
    """Warn in a sentence if the robot moves backwards or sideways by its marker's heading.

    The direction is that of the sum of all steps in the body frame, gaps left out. Less than 40
    degrees from the heading no sentence is returned, nor for a sum of under 5 cm, nor for a track
    without poses by the marker.
    """
    if all(seen.source != "marker" for seen in track.observations):
        return ()
    step = np.diff(track.poses[:, :2], axis=0)[~track.gap_before[1:]]
    yaw = (
        track.poses[:-1, 2][~track.gap_before[1:]]
        + 0.5 * np.diff(track.poses[:, 2])[~track.gap_before[1:]]
    )
    ahead = np.sum(step[:, 0] * np.cos(yaw) + step[:, 1] * np.sin(yaw))
    left = np.sum(step[:, 1] * np.cos(yaw) - step[:, 0] * np.sin(yaw))
    angle = float(np.arctan2(left, ahead))
    if np.hypot(ahead, left) < _STRAY or abs(angle) < _SIDEWAYS:
        return ()
    how = "backwards" if abs(angle) > _BACKWARDS else "sideways"
    return (
        f"the robot moves {how}, {np.degrees(angle):+.0f} degrees from its heading: unless it was "
        "made to, its print is turned on the body; correct marker.roll_pitch_yaw_deg in robot.toml",
    )
