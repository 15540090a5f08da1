# SPDX-License-Identifier: MIT
"""Resolve head and tail of a robot without a marker over a whole sequence (Viterbi).

One photograph of a nearly symmetric robot says little about which end is ahead, and shadows can
bias every photograph in the same way. But a robot does not turn round between two photographs, and
it walks head first. The most likely chain of headings is taken, and it must be far more likely than
the same chain with head and tail exchanged.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from model.arrays import Array
from tracking.body.align import Alignment
from tracking.body.search import BodyCandidates
from tracking.errors import AmbiguousHeading

LEAST_LOG_ODDS = 7.0
"""Least log odds of the chosen headings to the exchanged ones: a thousand to one [-]."""

_TURN_SD = 0.5  # of the turn between two photographs [rad]
_MOST_EVIDENCE = 6.0  # largest log odds of headings that one photograph may give
_TRAVEL_EVIDENCE = 6.0  # log score of a move straight ahead


def resolve_headings(
    candidates: Sequence[BodyCandidates], *, length: float, walks_ahead: bool = True
) -> tuple[Alignment, ...]:
    """Choose the robot's heading in every photograph by the most likely sequence (Viterbi).

    Args:
        candidates: Alignments of the robot in each photograph, in order of time.
        length: Length of the robot; moves shorter than a quarter of it give no direction [m].
        walks_ahead: Whether the robot is known to walk head first, on the whole.

    Returns:
        One of the `options` of each photograph; empty without candidates.

    Raises:
        AmbiguousHeading: When the best sequence of headings is less than about a thousand times
            (`LEAST_LOG_ODDS`) likelier than the best with head and tail exchanged throughout.
    """
    options = [candidate.options for candidate in candidates]
    # Bounded: shadows and glare can make one photograph overconfident.
    scores = [np.maximum(candidate.evidence, -_MOST_EVIDENCE) for candidate in candidates]
    links = [
        np.array([[_link(i, j, length, walks_ahead) for j in after] for i in before])
        for before, after in pairwise(options)
    ]
    choice, best = _likeliest(scores, links)
    odds = best - _score_reversed(options, choice, scores, links)
    if candidates and odds < LEAST_LOG_ODDS:
        raise AmbiguousHeading(
            f"head and tail of the robot cannot be distinguished: the headings found in "
            f"{len(candidates)} photographs are likelier than reversed by {np.exp(odds):.1f} to 1, "
            f"expected at least 1000 to 1; put a mark on its nose, or raise front_margin in "
            f"annotations.toml so that the template includes the nose",
            float(np.exp(odds)),
        )
    return tuple(ways[k] for ways, k in zip(options, choice, strict=True))


def _link(before: Alignment, after: Alignment, length: float, walks_ahead: bool) -> float:
    """Compute the log score of two successive alignments from turn and direction of the move.

    A turn lowers it by half the square of turn over `_TURN_SD`, at most by 10. If the robot
    `walks_ahead` and moved by over a quarter of its `length`, 6 times the cosine between move and
    mean heading is added.
    """
    a, b = before.pose.planar, after.pose.planar
    turn = float(np.angle(np.exp(1j * (b[2] - a[2]))))
    score = -0.5 * min((turn / _TURN_SD) ** 2, 20.0)
    move = b[:2] - a[:2]
    distance = float(np.hypot(*move))
    if walks_ahead and distance > 0.25 * length:
        heading = a[2] + turn / 2
        ahead = (move[0] * np.cos(heading) + move[1] * np.sin(heading)) / distance
        score += _TRAVEL_EVIDENCE * float(ahead)
    return score


def _likeliest(scores: Sequence[Array], links: Sequence[Array]) -> tuple[list[int], float]:
    """Return the index of each photograph's option in the best chain, and the chain's score.

    Scores by photograph and option are added, links by pair of neighbours, option before and after.
    Without photographs the chain is empty, its score 0.
    """
    if not scores:
        return [], 0.0
    total, came = scores[0], []
    for own, link in zip(scores[1:], links, strict=True):
        through = total[:, None] + link
        came.append(through.argmax(axis=0))
        total = through.max(axis=0) + own
    choice = [int(total.argmax())]
    for source in reversed(came):
        choice.append(int(source[choice[-1]]))
    return choice[::-1], float(total.max())


def _score_reversed(
    options: Sequence[Sequence[Alignment]], choice: Sequence[int], scores: Sequence[Array],
    links: Sequence[Array],
) -> float:  # fmt: skip
    """Compute the best total score with head and tail exchanged in every photograph.

    A photograph without an option opposite to the chosen one, by over 134 degrees, keeps the chosen
    one, with the lowest score.
    """
    against = []
    for ways, k, own in zip(options, choice, scores, strict=True):
        yaw = ways[k].pose.state[5]
        opposite = np.array([np.cos(way.pose.state[5] - yaw) < -0.7 for way in ways])
        against.append(
            np.where(opposite, own, -np.inf)
            if opposite.any()
            else np.where(np.arange(len(ways)) == k, -_MOST_EVIDENCE, -np.inf)
        )
    return _likeliest(against, links)[1]
