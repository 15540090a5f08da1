# SPDX-License-Identifier: MIT
"""Suggested points and what is expected of them, as a value and in numbers."""

from dataclasses import asdict, dataclass

from rig.experiment.plan import Plan
from zebro_lab.suggest.folder import Expected
from zebro_lab.suggest.proposal import Knowledge, Proposal


@dataclass(frozen=True)
class Suggested:
    """Suggested points, and what is expected of them.

    Attributes:
        plan: The plan as it is.
        plan_seconds: Its estimated duration [s].
        proposal: The proposed points.
        expected: Standard deviations of each part of each target.
        knowledge: What was known before.
        calibration: Name of the calibration's folder.
        source: Source of the calibration's data.
        notes: What the proposal assumes, one line each.
    """

    plan: Plan
    plan_seconds: float
    proposal: Proposal
    expected: tuple[Expected, ...]
    knowledge: Knowledge
    calibration: str
    source: str
    notes: tuple[str, ...]


def points_of(suggested: Suggested) -> dict[str, object]:
    """Return the proposed points in numbers, for manifest and document."""
    proposal = suggested.proposal
    return {
        "loads_N": list(proposal.plan.points.loads),
        "slips": [
            {"slip_ratio": float(slip), "points": int(count)}
            for slip, count in zip(proposal.slips, proposal.counts, strict=True)
        ],
        "point_s": proposal.plan.points.duration,
        "duration_s": proposal.seconds,
        "plan_duration_s": suggested.plan_seconds,
        "expected": [asdict(row) for row in suggested.expected],
    }
