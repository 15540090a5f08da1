# SPDX-License-Identifier: MIT
"""Test for steady state, and quality checks of a recorded point."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.ma  # np.median would import it while the discs turn

from model.arrays import Array
from rig.experiment.plan import Acceptance, SettleCriterion
from rig.experiment.readings import Readings
from rig.experiment.steps import Point
from rig.slip_rig.decode import measured_slip
from rig.slip_rig.profile import RigProfile

LEAST_COVERED: Final = 0.8
"""Least fraction of a point's duration that its samples must span [-]."""
SAME_SLIP: Final = 0.02
"""Largest difference of two slip ratios that count as the same one [-]."""
LEAST_SLIP: Final = 0.1
"""Least slip ratio at which frictions are compared: below, that of a law with a constant initial
slope falls as the load grows, and noise counts [-]."""
FRICTION_RATIOS: Final = (0.5, 1.5)
"""Expected range of friction at the smaller of two loads over that at the larger [-].

A load that is left on the cell during its zero makes readings of normal force too small, and so
friction too large, most at small loads. The thesis's law, whose friction grows with the load, goes
down to 0.63.
"""


@dataclass(frozen=True)
class PointVerdict:
    """Result of the quality checks of a recorded point.

    Attributes:
        problems: Why the point must be repeated, one phrase each; empty where it is good.
        samples: Number of recorded samples.
        slip: Mean slip ratio; NaN with fewer than 8 samples [-].
        friction: Sum of the traction over sum of the normal force; NaN where the latter is not
            above 0, or with fewer than 8 samples [-].
        normal_force: Median normal force; NaN with fewer than 8 samples [N].
    """

    problems: tuple[str, ...]
    samples: int
    slip: float
    friction: float
    normal_force: float

    @property
    def accepted(self) -> bool:
        """Return whether the point passed every check."""
        return not self.problems


def contradiction(point: Point, verdict: PointVerdict, others: Mapping[Point, PointVerdict]) -> str:
    """Compare the friction of a point with that at the same slip ratio and other loads.

    Args:
        point: The point.
        verdict: Its verdict.
        others: Verdicts of other points; only accepted ones are compared.

    Returns:
        Warning that names the first point beyond `FRICTION_RATIOS` and this one; empty without.
    """
    for other, judged in others.items():
        pair = sorted(((point, verdict), (other, judged)), key=lambda item: item[0].load)
        (light, small), (heavy, large) = pair
        alike = abs(small.slip - large.slip) <= SAME_SLIP and abs(small.slip) >= LEAST_SLIP
        least, most = (ratio * abs(large.friction) for ratio in FRICTION_RATIOS)
        contradict = light.load < heavy.load and not least <= abs(small.friction) <= most
        if judged.accepted and alike and contradict:
            found = f"{small.friction:.3f} in {light.label}, {large.friction:.3f} in {heavy.label}"
            return f"friction is {found}: loads seldom differ so; check the zero of the load cell"
    return ""


def span(readings: Readings) -> float:
    """Compute the time from the first sample to the last one; 0 for fewer than two [s]."""
    return float(readings.t[-1] - readings.t[0]) if len(readings) else 0.0


def halves(readings: Readings) -> tuple[Readings, Readings]:
    """Split one or more readings at the middle of their time, which the second half includes.

    A single reading is the second half, and the first one is empty.
    """
    middle = (readings.t[0] + readings.t[-1]) / 2
    late = readings.since(middle)
    early = len(readings) - len(late)
    first = Readings(*(column[:early] for column in vars(readings).values()))
    return first, late


def friction(readings: Readings) -> float:
    """Compute the sum of the traction over the sum of the normal force [-].

    NaN where the sum of the normal force is not above 0.
    """
    load = float(readings.normal_force.sum())
    return float(readings.traction_force.sum()) / load if load > 0 else np.nan


def is_steady(window: Readings, wanted: tuple[float, float], criterion: SettleCriterion) -> bool:
    """Return whether speeds are at their set-points, and halves agree in speeds and friction.

    Args:
        window: Readings of the latest `criterion.window`.
        wanted: Set-points of leg and ground disc [rad/s].
        criterion: Length of the window and tolerances.

    Returns:
        Whether the means are within the tolerances; False also for fewer than 8 readings, where
        they span less than 0.9 of `criterion.window`, or where a half has no normal force above 0.
    """
    if len(window) < 8 or window.t[-1] - window.t[0] < 0.9 * criterion.window:
        return False
    first, late = halves(window)
    if not len(first) or not len(late):
        return False
    for name, target in zip(("omega_leg", "omega_ground"), wanted, strict=True):
        means = [getattr(part, name).mean() for part in (window, first, late)]
        if abs(means[0] - target) > criterion.speed or abs(means[2] - means[1]) > criterion.speed:
            return False
    return abs(friction(late) - friction(first)) <= criterion.friction


def judge_point(
    readings: Readings,
    point: Point,
    accept: Acceptance,
    *,
    settled: bool,
    duration: float,
    profile: RigProfile,
) -> PointVerdict:
    """Check that a recorded point was settled, long enough, and kept its slip and friction.

    Args:
        readings: Recorded samples, zero subtracted, to span `LEAST_COVERED` of `duration`.
        point: Point with the commanded slip ratio.
        accept: Largest deviations and drifts of an accepted point.
        settled: Whether the rig was steady when recording began.
        duration: Intended duration of the recording [s].
        profile: Profile of the rig, with the radii of the discs.

    Returns:
        The verdict; with fewer than 8 samples that is the only problem, and means are NaN. The
        normal force is not checked: the ground disc may stand on its bump.
    """
    if len(readings) < 8:
        few = f"{len(readings)} samples were recorded (expected at least 8)"
        return PointVerdict((few,), len(readings), np.nan, np.nan, np.nan)
    slip = measured_slip(readings.omega_leg, readings.omega_ground, profile)
    problems = [] if settled else ["the rig was not steady within settle.timeout"]
    covered = span(readings)
    if covered < LEAST_COVERED * duration:
        problems.append(f"the samples cover {covered:.2f} s of the {duration:g} s to be recorded "
                        f"(expected {100 * LEAST_COVERED:g} % or more)")  # fmt: skip
    return PointVerdict(
        problems=(*problems, *_deviations(readings, slip, point, accept)),
        samples=len(readings),
        slip=float(slip.mean()),
        friction=friction(readings),
        normal_force=float(np.median(readings.normal_force)),
    )


def _deviations(readings: Readings, slip: Array, point: Point, accept: Acceptance) -> Iterator[str]:
    """Yield a phrase for each of mean slip, slip drift and friction drift beyond its limit, or NaN.

    The drifts, second half less first half, are not checked in a sweep, whose mean slip ratio is
    compared with the mean over time of the commanded one.
    """
    wanted = float(np.mean([point.slip_at(f) for f in np.linspace(0, 1, 101)]))
    off = float(slip.mean()) - wanted
    if not abs(off) <= accept.slip:
        yield f"mean slip ratio is {off:+.4f} off its set-point (limit {accept.slip:g})"
    if point.kind != "sweep":
        first, late = halves(readings)
        drift = float(slip[len(first) :].mean() - slip[: len(first)].mean())
        if not abs(drift) <= accept.slip_drift:
            limit = accept.slip_drift
            yield f"slip ratio drifted by {drift:+.4f} from first to second half (limit {limit:g})"
        change = friction(late) - friction(first)
        if not abs(change) <= accept.friction_drift:
            limit = accept.friction_drift
            yield f"friction drifted by {change:+.3f} from first to second half (limit {limit:g})"
