# SPDX-License-Identifier: MIT
"""Spread of the edges of the robot's marker from photograph to photograph.

The floor's markers tell how far edges lie outwards from marker to marker, but there are few of
them. The walk tells more: a marker that looks too large looks too near, and moves the robot along
the line of sight, to and fro between photographs, which a walking robot does not do. A walk without
such steps says nothing against a large spread: edges that lie outwards alike in neighbouring
photographs move a whole stretch of the path.
"""

from collections.abc import Sequence

import numpy as np

from tracking.corrections import Correction, Flip, replay
from tracking.detect import Detection, MarkedRobot, observe
from tracking.floor import EDGE_SPREADS, EdgeSpread, FloorFit
from tracking.path import assemble_track
from tracking.photos.result import Times
from tracking.shared import SharedErrors

_LONGEST = 100  # photographs
_NEGLIGIBLE = 1e-3


def edge_spread(
    fit: FloorFit, detections: Sequence[Detection], *, robot: MarkedRobot, times: Times,
    shared: SharedErrors, gap: float | None, corrections: Sequence[Correction] = (),
) -> EdgeSpread:  # fmt: skip
    """Weigh the spreads that the floor's markers leave by the likelihood of the walk.

    Args:
        fit: The camera and the floor, with the edges of its markers.
        detections: Markers detected in each photograph, of which the first 100 with the robot's
            are used.
        robot: The robot's marker and prior.
        times: By photograph, time and its standard deviation [s].
        shared: Covariance of the errors that photographs share.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        corrections: Manual corrections; photographs whose pose they delete or set are not used.

    Raises:
        CorrectionError: A correction names a photograph without a pose, or one twice.
        PathError: Two photographs have the same time, after corrections of it.
    """
    usable = [each for each in detections if each.robot is not None]
    usable = [each for each in usable if each.photo not in fit.unused]
    flips: list[Flip] = []
    if corrections:
        poses = observe(fit, usable, robot=robot, times=times)
        poses = replay(poses, corrections, prior=robot.prior, times=times)
        kept = {each.photo: (each.t, each.t_sd) for each in poses if each.source == "marker"}
        usable, times = [each for each in usable if each.photo in kept], kept
        usable.sort(key=lambda each: kept[each.photo])
        flips = [each for each in corrections if isinstance(each, Flip)]
    usable = usable[:_LONGEST]
    flips = [each for each in flips if each.photo in {seen.photo for seen in usable}]
    known = fit.edge_spread
    if len(usable) < 3:
        return known
    logs = np.full(len(EDGE_SPREADS), -np.inf)
    process = None
    first = int(np.argmax(known.weights > _NEGLIGIBLE))
    for k in range(first, len(EDGE_SPREADS)):
        if known.weights[k] <= _NEGLIGIBLE and logs[k - 1] < logs.max():
            break  # neither the floor's markers nor the walk ask for still larger spreads
        seen = observe(fit, usable, robot=robot, times=times, edge_sd=float(EDGE_SPREADS[k]))
        seen = replay(seen, flips, prior=robot.prior)
        track = assemble_track(seen, shared=shared, prior=robot.prior, gap=gap, start=process,
                               average=False)  # fmt: skip
        process = track.smoothed.process
        logs[k] = track.smoothed.log_likelihood + sum(each.pose.log_evidence for each in seen)
    return EdgeSpread(known.log_weights + np.maximum.accumulate(logs))
