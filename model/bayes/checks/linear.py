# SPDX-License-Identifier: MIT
r"""Score tests: would one more term in the model of the data explain what the fit leaves?

Around the posterior's centre the model is linear: with F the measured block means, L the Cholesky
factor of their covariance, f their prediction, J its derivative by the d fitted coordinates z, and
y(z) ~ N(0, 1) a priori with the derivative Y (y is z itself unless z is straightened),

.. math::
    r = \begin{pmatrix} L^{-1}(F - f) \\ -y(\hat z) \end{pmatrix}, \qquad
    A = \begin{pmatrix} L^{-1} J \\ Y \end{pmatrix}, \qquad
    D = \begin{pmatrix} L^{-1} t \\ 0 \end{pmatrix}

of a further term a·t, t one force a block. What the fit could absorb is projected out of r and D,
and a = D·r/|D|^2 with the variance 1/|D|^2. That is the estimate a full fit with the term would
give, at the cost of a few predictions.

One column of A is no parameter of the fit. The mean of the curve over a block depends on how slip
is distributed within it, which the fit takes for Gaussian. A speed that ripples as discs turn has
another distribution, and where a curve rises within a few of its standard deviations that moves
the mean by a hundredth of the peak. The column is what the distribution of a sine wave would
change, with a multiple of N(0, 1) a priori, so that no check blames it on law or sensors.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import stdtr

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import PredictedForces, covariance_factors, predict_blocks
from model.bayes.posterior import SlipPosterior
from model.slip.law import SlipLaw

STEP = 1e-3  # of a coordinate, whose prior has unit scale
SLIP_STEP = 1e-5  # of the slip ratio


@dataclass(frozen=True)
class Term:
    """Estimate of a term that the model lacks.

    Attributes:
        size: Estimated multiple of the term.
        sd: Its standard deviation: that of the model, or from the scatter between runs if larger.
        p: Two-sided p-value of a multiple of zero, by Student's t. Its degrees of freedom are the
            number of runs less one, or of one run the number of blocks [-].
    """

    size: float
    sd: float
    p: float

    @property
    def t(self) -> float:
        """Size over standard deviation [-]."""
        return self.size / self.sd


@dataclass(frozen=True)
class Linearised:
    """A fit around its centre, with all that it can absorb projected out.

    Attributes:
        blocks: The block means, n of them.
        predicted: Predictions at the centre, arrays of shape (n,).
        per_slip: Derivative of the predicted force by a shift of all slip, shape (n,) [N]. It is
            not `predicted.slope`, the slope across the spread of slip: where the curve is bent
            the two differ, and a fitted shift moves the force by this.
        residual: Measured minus predicted traction, shape (n,) [N].
        factors: Lower Cholesky factor of each run's covariance [N].
        basis: Orthonormal basis of the columns of A, shape (n + d + 1, d + 1) [-].
        triangle: A in that basis, upper triangular, shape (d + 1, d + 1) [-].
        rest: r without what the fit could absorb, shape (n + d + 1,) [-].
        values: Law and measurement parameters at the centre, shape (k + 11,).
        z: Coordinates of the centre, shape (d,).
    """

    blocks: SlipBlocks
    predicted: PredictedForces
    per_slip: Array
    residual: Array
    factors: list[Array]
    basis: Array
    triangle: Array
    rest: Array
    values: Array
    z: Array

    def project(self, terms: Array) -> Array:
        """Whiten terms, shape (n, m) [N], and take out what A absorbs, (n + d + 1, m) [-]."""
        white = whiten(self.blocks, terms, self.factors)
        padded = np.vstack([white, np.zeros((self.basis.shape[1], terms.shape[1]))])
        return padded - self.basis @ (self.basis.T @ padded)

    def absorbed(self, term: Array) -> Array:
        """Compute how far coordinates move to follow a term in the forces, to first order, (d,).

        Args:
            term: A force added to each block, shape (n,) [N].
        """
        white = whiten(self.blocks, term[:, None], self.factors)[:, 0]
        return solve_triangular(self.triangle, self.basis[: len(white)].T @ white)[:-1]

    def spread(self) -> Array:
        """Compute the posterior standard deviation of each coordinate, shape (d,) [-]."""
        return np.sqrt(np.sum(np.linalg.inv(self.triangle) ** 2, axis=1))[:-1]

    def beyond_fit(self, term: Array) -> Array:
        """Return a term, shape (n,) [N], less what the fit would absorb of it, shape (n,) [N]."""
        left = self.project(term[:, None])[: len(self.blocks), 0]
        parts = np.split(left, self.blocks.run_starts()[1:-1])
        return np.concatenate([L @ part for L, part in zip(self.factors, parts, strict=True)])

    def test(self, term: Array) -> Term:
        """Estimate the multiple of a term, shape (n,) [N], that the data ask for beside the fit.

        A term that the fit absorbs to one part in a thousand has the size 0, an infinite standard
        deviation and the p-value 1.
        """
        white = whiten(self.blocks, term[:, None], self.factors)[:, 0]
        left = self.project(term[:, None])[:, 0]
        information = float(left @ left)
        if information <= 1e-6 * float(white @ white):
            return Term(0.0, float("inf"), 1.0)
        size = float(left @ self.rest) / information
        sd = 1 / np.sqrt(information)
        n_runs = self.blocks.n_runs
        if n_runs > 1:
            own = left * (self.rest - size * left)
            by_run = np.bincount(self.blocks.run, own[: len(self.blocks)], minlength=n_runs)
            scatter = np.sqrt(np.sum(by_run**2) * n_runs / (n_runs - 1)) / information
            sd = max(sd, float(scatter))
        freedom = max(n_runs - 1, 1) if n_runs > 1 else len(self.blocks)
        return Term(size, sd, float(2 * stdtr(freedom, -abs(size / sd))))


def linearise(posterior: SlipPosterior, z: Array) -> Linearised:
    """Linearise a fit around the mean of posterior draws.

    Args:
        posterior: The posterior density, with blocks, law and priors.
        z: Draws of its coordinates, shape (w, d).

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    centre = z.mean(axis=0)
    step = STEP * np.eye(len(centre))
    around = np.concatenate([centre[None], centre + step, centre - step])
    values = posterior.values(around)
    blocks, law = posterior.blocks, posterior.law
    every = predict_blocks(blocks, law, values)
    predicted = every.of_vector(0)
    d = len(centre)
    jacobian = (every.force[1 : d + 1] - every.force[d + 1 :]).T / (2 * STEP)
    factors = covariance_factors(blocks, predicted, values[0])
    residual = blocks.traction_force - predicted.force
    ripple = predict_blocks(blocks, law, values[:1], sine=True).force[0] - predicted.force
    white = whiten(blocks, np.column_stack([residual, jacobian, ripple]), factors)
    prior = posterior.prior_coordinates(around)
    prior_jacobian = np.eye(d + 1)  # that of the ripple's multiple is 1
    prior_jacobian[:d, :d] = (prior[1 : d + 1] - prior[d + 1 :]).T / (2 * STEP)
    basis, triangle = np.linalg.qr(np.vstack([white[:, 1:], prior_jacobian]))
    right = np.concatenate([white[:, 0], -prior[0], [0.0]])
    return Linearised(
        blocks,
        predicted,
        _per_slip(blocks, law, values[:1]),
        residual,
        factors,
        basis,
        triangle,
        right - basis @ (basis.T @ right),
        values[0],
        centre,
    )


def _per_slip(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the derivative of predicted force by a shift of all slip, shape (n,) [N]."""
    above, below = (
        predict_blocks(replace(blocks, slip=blocks.slip + step), law, values).force[0]
        for step in (SLIP_STEP, -SLIP_STEP)
    )
    return (above - below) / (2 * SLIP_STEP)


def whiten(blocks: SlipBlocks, columns: Array, factors: list[Array]) -> Array:
    """Solve L x = c for each run's part of each column c, by the run's factor L.

    Columns and result have shape (n, m); their n rows are the blocks, run by run.
    """
    parts = np.split(columns, blocks.run_starts()[1:-1])
    return np.concatenate(
        [solve_triangular(L, part, lower=True) for L, part in zip(factors, parts, strict=True)]
    )
