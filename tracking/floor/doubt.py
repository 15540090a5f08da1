# SPDX-License-Identifier: MIT
"""Which stated value of floor or lens does not fit: alternatives in which one may be far off."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracking.camera.lens import Camera
from tracking.floor.adjustment import Adjusted, Adjustment
from tracking.floor.edge_spread import EDGE_SCALE, EDGE_SPREADS
from tracking.floor.marks import Mark

REMARKABLE = 2.5
"""Log odds from which a stated value of floor or lens is suspected [-].

Of 160 simulated sound walks two reach it (`benchmarks.accuracy.planted_track_faults` at the tag
`full-toolkit`)."""

_FAR = 6.0  # times its standard deviation that a suspected mark may be off
_LENS = 0.02  # standard deviation of the focal length of a suspected lens, of itself
_SPREADS = EDGE_SPREADS[::3]
_AS_LIKELY = 4.0  # log odds between values that explain the photographs about as well


@dataclass(frozen=True)
class SuspectValue:
    """A stated value that may be wrong.

    Attributes:
        what: The value in words, such as "the side of the robot's marker".
        finding: What it would have to be, as by `more_or_less`.
        log_odds: Log of how much likelier the photographs are if this value alone is off by far
            more than its standard deviation [-].
    """

    what: str
    finding: str
    log_odds: float


def more_or_less(off: float, unit: str) -> str:
    """Format how far a value would be from the stated one.

    >>> more_or_less(-2.44, " mm")
    '2.4 mm less than stated'
    """
    return f"{abs(off):.1f}{unit} {'more' if off > 0 else 'less'} than stated"


def suspicion(suspects: Sequence[SuspectValue], *, remarkable: float) -> tuple[str, ...]:
    """Format a warning that names the likeliest suspect, and those of log odds less than 4 lower.

    Args:
        suspects: All values that were tried.
        remarkable: Log odds from which a suspect is named. The more values are tried, the higher
            they rise by chance [-].

    Returns:
        One sentence; empty where no suspect reaches `remarkable`.
    """
    ranked = sorted(suspects, key=lambda each: -each.log_odds)
    if not ranked or ranked[0].log_odds < remarkable:
        return ()
    best, *others = ranked
    text = f"{best.what} does not fit the photographs: it seems to be {best.finding}"
    rivals = [
        f"{each.what} ({each.finding})"
        for each in others
        if each.log_odds > best.log_odds - _AS_LIKELY
    ]
    if rivals:
        text += f"; this cannot be told apart from {', or '.join(rivals)}"
    return (f"{text}; measure again",)


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
    """Yield each mark's place, then the side of all prints, then the focal length as suspects.

    For each the problem is fitted again with a larger standard deviation of this value alone, and
    the evidence is compared with that of `plain`, the fit with the stated ones.
    """
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
    """Compare with an alternative in which the sides of all floor markers may be far off.

    Their standard deviations are `_FAR` times those stated; found is the mean relative change.
    """
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
    """Compare with an alternative in which the focal length may be off by `_LENS` of itself."""
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
    """Fit for each of `_SPREADS` of edges, and return the likeliest fit.

    Its log evidence is that of all spreads: the log of the sum of their evidences times priors.
    """
    fits = []
    for sd in _SPREADS:
        tried = replace(problem, edge_sd=float(sd))
        found = tried.fitted(found)
        # Half-Cauchy, as a density of the logarithm: the spreads are spaced evenly in it.
        prior = float(np.log(sd) - np.log1p((sd / EDGE_SCALE) ** 2))
        fits.append(_Weighed(tried, found, tried.log_evidence(found) + prior))
    best = max(fits, key=lambda fit: fit.log_evidence)
    logs = np.array([fit.log_evidence for fit in fits])
    total = best.log_evidence + float(np.log(np.exp(logs - best.log_evidence).sum()))
    return replace(best, log_evidence=total)
