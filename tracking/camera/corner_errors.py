# SPDX-License-Identifier: MIT
"""Errors of the corners of a calibration board, and the covariance of the lens that follows.

A bent board, blur or a wide refinement window moves neighbouring corners of a photograph alike, so
that corners tell less about the lens than as many independent ones. In each photograph, for x and
for y, errors have the covariance

    V = noise² (I + ratio² K),    K_ij = exp(-|p_i - p_j|² / (2 reach²)),

with p the corners on the board. Ratio and reach are those of greatest restricted likelihood (REML),
the pose of the board in each photograph and the lens being free.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from model.arrays import Array

RATIOS = np.concatenate(([0.0], np.geomspace(0.1, 10.0, 17)))
"""Ratios of smooth error to noise that are tried [-]."""
_LEAST_NOISE = 1e-6  # px, of corners that fit as exactly as numbers hold
REACHES = (0.1, 0.2, 0.4)
"""Reaches that are tried, in diagonals of the board [-]."""


@dataclass(frozen=True)
class FittedBoard:
    """A board in one photograph, compared with the fitted lens and pose of the board.

    Attributes:
        points: The n corners on the board, shape (n, 2) [m].
        missed: Detected minus predicted corners, shape (n, 2) [px].
        by_pose: Derivative of the predicted corners by the pose of the board, shape (n, 2, 6).
        by_lens: Derivative of them by the k fitted parameters of the lens, shape (n, 2, k).
    """

    points: Array
    missed: Array
    by_pose: Array
    by_lens: Array


@dataclass(frozen=True)
class CornerErrors:
    """Errors of corners, and of the lens that was fitted to them by least squares.

    Attributes:
        noise: Standard deviation of a corner's own error, in x and in y [px].
        smooth: Standard deviation of the error that it shares with its neighbours [px].
        reach: Distance on the board over which errors are alike [m].
        covariance: Covariance of the k fitted parameters of the lens, shape (k, k).
    """

    noise: float
    smooth: float
    reach: float
    covariance: Array


def corner_errors(boards: Sequence[FittedBoard]) -> CornerErrors:
    """Estimate the errors of corners, and the covariance of a lens that was fitted to them.

    Of all `RATIOS` and `REACHES` those of greatest restricted likelihood are taken.

    Args:
        boards: The board in each photograph, for a lens and poses fitted by unweighted least
            squares.
    """
    diagonal = max(float(np.linalg.norm(np.ptp(board.points, axis=0))) for board in boards)
    tried = [_likelihood(boards, reach * diagonal) for reach in REACHES]
    logs = np.array([logs for logs, _ in tried])
    i, j = np.unravel_index(np.argmax(logs), logs.shape)
    reach, noise = REACHES[i] * diagonal, float(np.sqrt(tried[i][1][j]))
    covariance = _of_lens(boards, reach, noise, float(RATIOS[j]))
    return CornerErrors(noise, noise * float(RATIOS[j]), reach, covariance)


def _likelihood(boards: Sequence[FittedBoard], reach: float) -> tuple[Array, Array]:
    """Compute, for all `RATIOS` at a reach [m], the restricted log likelihood and its best noise².

    Noise² is the variance that maximises the likelihood at each ratio [px²]; shape (ratios,) each.
    """
    rotated = [_in_modes(board, reach) for board in boards]
    free = sum(board.missed.size for board in boards) - 6 * len(boards)
    k = boards[0].by_lens.shape[2]
    logs, variances = np.empty(len(RATIOS)), np.empty(len(RATIOS))
    for j, ratio in enumerate(RATIOS):
        log_det, square = 0.0, 0.0
        information, pull = np.zeros((k, k)), np.zeros(k)
        for strength, missed, by_pose, by_lens in rotated:
            weight = 1 / (1 + ratio**2 * strength)  # of a mode, for x and y
            log_det -= 2 * float(np.log(weight).sum())
            all_of = np.concatenate((by_pose, by_lens, missed[:, :, None]), axis=2)
            normal = np.einsum("nai,n,naj->ij", all_of, weight, all_of)
            log_det += float(np.linalg.slogdet(normal[:6, :6])[1])
            # Schur complement: the pose of the board is eliminated.
            rest = normal[6:, 6:] - normal[6:, :6] @ np.linalg.solve(normal[:6, :6], normal[:6, 6:])
            information, pull = information + rest[:k, :k], pull + rest[:k, k]
            square += float(rest[k, k])
        square -= float(pull @ np.linalg.solve(information, pull)) if k else 0.0
        log_det += float(np.linalg.slogdet(information)[1]) if k else 0.0
        variances[j] = max(square, _LEAST_NOISE**2 * (free - k)) / (free - k)
        logs[j] = -0.5 * (log_det + (free - k) * np.log(variances[j]))
    return logs, variances


def _in_modes(board: FittedBoard, reach: float) -> tuple[Array, Array, Array, Array]:
    """Rotate a board's errors and derivatives to the eigenvectors of K; return eigenvalues first.

    Eigenvalues have the shape (n,), the others keep theirs.
    """
    strength, modes = np.linalg.eigh(_likeness(board.points, reach))
    turned = (
        np.einsum("ni,n...->i...", modes, each)
        for each in (board.missed, board.by_pose, board.by_lens)
    )
    return (np.maximum(strength, 0.0), *turned)


def _likeness(points: Array, reach: float) -> Array:
    """Compute K, the correlation of smooth errors at the corners by their distance, (n, n)."""
    offset = points[:, None] - points[None]
    return np.exp(-np.sum(offset**2, axis=2) / (2 * reach**2))


def _of_lens(boards: Sequence[FittedBoard], reach: float, noise: float, ratio: float) -> Array:
    """Compute the covariance of a lens fitted by unweighted least squares, errors being of V.

    With N the derivatives by the lens without what the pose of the board can make up for, it is
    (N'N)^-1 N'VN (N'N)^-1.
    """
    k = boards[0].by_lens.shape[2]
    information, scatter = np.zeros((k, k)), np.zeros((k, k))
    for board in boards:
        n = len(board.points)
        by_pose, by_lens = board.by_pose.reshape(2 * n, 6), board.by_lens.reshape(2 * n, k)
        reduced = by_lens - by_pose @ np.linalg.lstsq(by_pose, by_lens, rcond=None)[0]
        V = noise**2 * (np.eye(n) + ratio**2 * _likeness(board.points, reach))
        information += reduced.T @ reduced
        by_corner = reduced.reshape(n, 2, k)
        scatter += np.einsum("nai,nm,maj->ij", by_corner, V, by_corner)
    inverse = np.linalg.inv(information)
    return inverse @ scatter @ inverse
