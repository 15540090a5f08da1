# SPDX-License-Identifier: MIT
"""Which stated value of floor or lens does not fit: alternatives in which one may be far off."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tracking.camera.lens import Camera
from tracking.floor.adjustment import EDGE_SCALE, EDGE_SPREADS, Adjusted, Adjustment
from tracking.floor.marks import Mark
from tracking.suspect import SuspectValue, more_or_less

REMARKABLE = 2.5
"""Log odds from which a stated value of floor or lens is suspected [-].

Of 160 simulated sound walks two reach it (`benchmarks.accuracy.planted_track_faults` at the tag
`full-toolkit`)."""

_FAR = 6.0  # times its standard deviation that a suspected mark may be off
_LENS = 0.02  # standard deviation of the focal length of a suspected lens, of itself
_SPREADS = EDGE_SPREADS[::3]


@dataclass(frozen=True)
class _Weighed:
    """A fitted alternative: its problem and solution for the likeliest edges, its evidence."""

    problem: Adjustment
    found: Adjusted
    log_evidence: float


def doubts(problem: Adjustment, found: Adjusted) -> tuple[SuspectValue, ...]:
    """Compare alternatives in which one mark, the prints or the lens may be far off.

    Each alternative is averaged over the spread of edges, since a wrong size would widen it.

    Args:
        problem: The adjustment.
        found: Its solution with the stated standard deviations or wider ones, to start from.

    Returns:
        One suspect for each alternative.
    """
    return tuple(_suspects(problem, _weighed(problem, found)))


def _suspects(problem: Adjustment, plain: _Weighed) -> Iterator[SuspectValue]:
    for key, mark in problem.floor.marks.items():
        loose = replace(mark, position_sd=_FAR * mark.position_sd)
        other = replace(problem, floor=problem.floor.with_marks({key: loose}))
        fit = _weighed(other, plain.found)
        x, y = (
            fit.found.floor.marks[key].points[:, :2].mean(axis=0) - mark.points[:, :2].mean(axis=0)
        ) * 1e3
        yield SuspectValue(
            f"the place of mark {key} in floor.toml",
            f"{x:+.1f} mm in x and {y:+.1f} mm in y from where it is stated",
            fit.log_evidence - plain.log_evidence,
        )  # fmt: skip
    if problem.floor.markers:
        yield _of_prints(problem, plain)
    yield _of_lens(problem, plain)


def _of_prints(problem: Adjustment, plain: _Weighed) -> SuspectValue:
    loose: dict[int | str, Mark] = {
        m.marker_id: replace(m, side_sd=_FAR * m.side_sd) for m in problem.floor.markers
    }
    fit = _weighed(replace(problem, floor=problem.floor.with_marks(loose)), plain.found)
    longer = np.mean([
        found.side / stated.side - 1
        for found, stated in zip(fit.found.floor.markers, problem.floor.markers, strict=True)
    ])  # fmt: skip
    return SuspectValue(
        "the side of the floor's markers", more_or_less(1e2 * float(longer), "%"),
        fit.log_evidence - plain.log_evidence,
    )  # fmt: skip


def _of_lens(problem: Adjustment, plain: _Weighed) -> SuspectValue:
    other = replace(problem, camera=_loose(problem.camera))
    start = replace(other.start(), floor=plain.found.floor, poses=plain.found.poses)
    fit = _weighed(other, start)
    longer = fit.problem.lens(fit.found).matrix[0, 0] / problem.camera.matrix[0, 0] - 1
    return SuspectValue(
        "the focal length in camera.toml", more_or_less(1e2 * float(longer), "%"),
        fit.log_evidence - plain.log_evidence,
    )  # fmt: skip


def _loose(camera: Camera) -> Camera:
    """Return the camera with focal lengths that may be off by `_LENS`, both alike."""
    off = np.zeros(9)
    off[:2] = _LENS * camera.matrix[[0, 1], [0, 1]]
    return replace(camera, covariance=camera.covariance + np.outer(off, off))


def _weighed(problem: Adjustment, found: Adjusted) -> _Weighed:
    """Fit for each of `_SPREADS` of edges; return the likeliest fit and the mean evidence."""
    fits = []
    for sd in _SPREADS:
        tried = replace(problem, edge_sd=float(sd))
        found = tried.fitted(found)
        prior = float(np.log(sd) - np.log1p((sd / EDGE_SCALE) ** 2))
        fits.append(_Weighed(tried, found, tried.log_evidence(found) + prior))
    best = max(fits, key=lambda fit: fit.log_evidence)
    logs = np.array([fit.log_evidence for fit in fits])
    total = best.log_evidence + float(np.log(np.exp(logs - best.log_evidence).sum()))
    return replace(best, log_evidence=total)
