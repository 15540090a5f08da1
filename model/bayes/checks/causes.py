# SPDX-License-Identifier: MIT
"""What may be wrong with data, as a closed list, and which of it explains a misfit best.

A finding counts where it is beyond chance *and* changes the answer: statistics of a million samples
find what no user would mind. A cause is named alone only where it explains the misfit clearly
better than the next; else two are named, and what they cannot be told by is left to the person.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from model.bayes.advice import Advice

LEAST_P: Final = 0.003
"""Probability by chance, over all terms that a question tries, up to which a finding is real."""
STIFFNESS: Final = 0.05
"""Relative change of the slope at zero slip from which a finding changes the answer [-]."""
FORCE: Final = 0.01
"""The same of a force, over the largest force [-]."""
RIVAL: Final = 0.4
"""Share of the best finding's gain, from which another is named beside it [-]."""
SPECIFIC: Final = 0.5
"""Share of a generic finding's gain, from which a specific one explains it [-]."""
CLOSE: Final = 9.0
"""Gain below the best finding's, up to which another is named beside it [-]."""
MOST_NAMED: Final = 2
"""Causes that are named."""


class Cause(StrEnum):
    """What may be wrong with data of a slip rig."""

    FORCE_ZERO = "the zero of traction"
    SLIP_ZERO = "the zero of slip (a radius)"
    FORCE_SCALE = "the unit, sign or range of a force"
    ONE_DIRECTION = "the gain of traction in one direction"
    LOAD = "the load column"
    CROSSTALK = "crosstalk between the forces"
    TIMING = "the timing of slip and force"
    HYSTERESIS = "hysteresis"
    DEFINITION = "the slip definition"
    SATURATION = "saturation of a force"
    FROZEN = "frozen samples"
    OUTLIERS = "outliers"
    STICK_SLIP = "stick-slip"
    RUN_OUT = "run-out of a disc"
    OVER_TIME = "friction that changes with time"
    MATERIALS = "two materials"
    COLUMN = "an unused column"
    LAW = "the shape of the slip law"


class Question(StrEnum):
    """The eight questions that a verdict answers."""

    SAMPLER = "Did the sampler converge?"
    PLAIN = "Does the plain fit agree?"
    POINTS = "Does the curve go through the points?"
    REPEAT = "Do runs repeat?"
    REACH = "Are rise and peak measured?"
    RAW = "Are the raw samples sound?"
    SLIP = "Is the slip plausible?"
    UNITS = "Are units and signs plausible?"


@dataclass(frozen=True)
class Effect:
    """Change of the answer by a finding.

    Attributes:
        stiffness: Relative change of the slope at zero slip [-].
        force: Change of a force over the largest force [-].
    """

    stiffness: float
    force: float

    @property
    def large(self) -> bool:
        """Whether it reaches `STIFFNESS` or `FORCE`."""
        return abs(self.stiffness) >= STIFFNESS or abs(self.force) >= FORCE

    def __str__(self) -> str:
        """Format both as text."""
        return f"slope {abs(self.stiffness):.1%}, force {abs(self.force):.1%} of the peak"


@dataclass(frozen=True)
class Finding:
    """Something beyond the model that the data may hold.

    Attributes:
        question: The question that it answers with no, where it is `real`.
        causes: What may be its cause, up to two, the likelier first.
        text: What was found, as text with its size.
        gain: Twice the log likelihood that it explains; infinite of what is plain to see [-].
        p: Probability of as much by chance, over all that the question tries [-].
        effect: How far it moves the answer.
        advice: What to do.
        generic: Whether it would also explain what other findings name: any difference between
            runs, any misfit of the curve.
    """

    question: Question
    causes: tuple[Cause, ...]
    text: str
    gain: float
    p: float
    effect: Effect
    advice: Advice
    generic: bool = False

    @property
    def real(self) -> bool:
        """Whether it is beyond chance and changes the answer."""
        return self.p <= LEAST_P and self.effect.large


def likely(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return the real finding that explains most, and those that cannot be told from it.

    A generic one is left out where a specific one explains `SPECIFIC` of as much.

    Args:
        findings: All findings.
    """
    real = [each for each in findings if each.real]
    most = max((each.gain for each in real if not each.generic), default=0.0)
    kept = [each for each in real if not (each.generic and most >= SPECIFIC * each.gain)]
    ranked = sorted(kept, key=lambda each: -each.gain)
    return tuple(
        each for each in ranked
        if each.gain >= RIVAL * ranked[0].gain or ranked[0].gain - each.gain < CLOSE
    )  # fmt: skip


def named(findings: Sequence[Finding]) -> tuple[Cause, ...]:
    """Return the causes to name, up to `MOST_NAMED`.

    They are the likelier cause of the best finding, then those of its rivals, then its other one.

    Args:
        findings: What `likely` returns.
    """
    first = [each.causes[0] for each in findings]
    further = [cause for each in findings for cause in each.causes[1:]]
    return tuple(dict.fromkeys([*first, *further]))[:MOST_NAMED]
