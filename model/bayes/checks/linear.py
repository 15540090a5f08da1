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
from scipy.special import fdtrc

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.checks.causes import Effect
from model.bayes.likelihood import PredictedForces, covariance_factors, predict_blocks
from model.bayes.posterior import SlipPosterior
from model.slip.law import SlipLaw

STEP = 1e-3  # of a coordinate, whose prior has unit scale
SLIP_STEP = 1e-5  # of the slip ratio


@dataclass(frozen=True)
class Term:
    """Estimate of m terms that the model lacks, together.

    Attributes:
        size: Estimated multiple of each, shape (m,).
        sd: Their standard deviations: those of the model, or from the scatter between runs if
            larger, shape (m,).
        p: Probability of multiples as far from zero by chance, by the F distribution. Its degrees
            of freedom are the number of runs less m, or of one run the number of blocks [-].
        gain: Twice the log likelihood that they explain [-].
    """

    size: Array
    sd: Array
    p: float
    gain: float


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
        features: Derivative by z of the logarithms of the slope at zero slip and of the force at
            the largest slip, both at the median load, shape (2, d) [-].
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
    features: Array

    def project(self, terms: Array) -> Array:
        """Whiten terms, shape (n, m) [N], and take out what A absorbs, (n + d + 1, m) [-]."""
        white = whiten(self.blocks, terms, self.factors)
        padded = np.vstack([white, np.zeros((len(self.rest) - len(white), terms.shape[1]))])
        return padded - self.basis @ (self.basis.T @ padded)

    def without(self, terms: Array) -> "Linearised":
        """Return the fit with terms, shape (n, m) [N], taken out of what it leaves.

        Its `basis` has their columns too, but `triangle` has not: `absorbed` and `effect` are those
        of the fit before. Directions that the fit absorbs stay, as in `test`.
        """
        white = whiten(self.blocks, terms, self.factors)
        scale = np.sqrt(np.maximum(np.sum(white**2, axis=0), 1e-300))
        left, size, _ = np.linalg.svd(self.project(terms) / scale, full_matrices=False)
        more = left[:, size > 1e-3]
        rest = self.rest - more @ (more.T @ self.rest)
        return replace(self, basis=np.hstack([self.basis, more]), rest=rest)

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

    def effect(self, term: Array) -> Effect:
        """Compute how far a term in the forces, shape (n,) [N], moves the answer.

        The change of a force is that of the curve, or what is left beside the curve if that is
        more: its root mean square over the largest predicted force.
        """
        moved = self.features @ self.absorbed(term)
        peak = max(float(np.abs(self.predicted.force).max()), 1e-300)
        left = float(np.sqrt(np.mean(self.beyond_fit(term) ** 2))) / peak
        return Effect(float(moved[0]), max(abs(float(moved[1])), left))

    def test(self, terms: Array) -> Term:
        """Estimate the multiples of terms, shape (n, m) [N], that the data ask for beside the fit.

        Terms that the fit absorbs to one part in a thousand have the size 0 and the p-value 1.
        """
        white = whiten(self.blocks, terms, self.factors)
        left = self.project(terms)
        scale = np.sqrt(np.maximum(np.sum(white**2, axis=0), 1e-300))
        D = left / scale
        size, vectors = np.linalg.eigh(D.T @ D)
        kept = size > 1e-6
        if not kept.any():
            return Term(np.zeros(len(scale)), np.full(len(scale), np.inf), 1.0, 0.0)
        inverse = (vectors[:, kept] / size[kept]) @ vectors[:, kept].T
        found = inverse @ (D.T @ self.rest)
        gain, rank = float(found @ (D.T @ self.rest)), int(kept.sum())
        variance, wald, n_runs = inverse, gain, self.blocks.n_runs
        if n_runs > rank + 1:
            own = D * (self.rest - D @ found)[:, None]
            by_run = np.add.reduceat(own[: len(self.blocks)], self.blocks.run_starts()[:-1])
            scatter = inverse @ (by_run.T @ by_run) @ inverse * n_runs / (n_runs - 1)
            wald = min(wald, float(found @ np.linalg.pinv(scatter, 1e-9) @ found))
            variance = np.maximum(np.diag(variance), np.diag(scatter))
        else:
            variance = np.diag(variance)
        freedom = max(n_runs - rank, 1) if n_runs > 1 else max(len(self.blocks) - rank, 1)
        p = float(fdtrc(rank, freedom, max(wald, 0.0) / rank))
        return Term(found / scale, np.sqrt(variance) / scale, p, gain)


def linearise(posterior: SlipPosterior, z: Array, *, zero_stability: float) -> Linearised:
    """Linearise a fit around the mean of posterior draws.

    Zeros of runs scatter by no more than the load cell's zero stability here: what the fit took for
    a larger scatter may have another cause.

    Args:
        posterior: The posterior density, with blocks, law and priors.
        z: Draws of its coordinates, shape (w, d).
        zero_stability: Scale of the zeros between runs that the load cell has [N].

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
    steady = np.append(values[0, :-1], min(float(values[0, -1]), zero_stability))
    factors = covariance_factors(blocks, predicted, steady)
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
        _features(posterior, values).T,
    )


def curve_features(law: SlipLaw, values: Array, blocks: SlipBlocks) -> Array:
    """Compute the logarithms of the slope at zero slip and of the force at the largest slip.

    Both are at the median load; shape (w, 2).

    Args:
        law: The slip law, of k parameters.
        values: Its parameters, shape (w, k).
        blocks: The block means, whose loads and slips count.
    """
    load, far = float(np.median(blocks.normal_force)), float(np.abs(blocks.slip).max())
    slope = law.slip_derivative(0.0, load, values.T)
    with np.errstate(invalid="ignore", divide="ignore"):  # a curve may have fallen to zero there
        return np.log(np.stack([slope, law.force(far, load, values.T)], axis=-1))


def _features(posterior: SlipPosterior, values: Array) -> Array:
    """Compute the derivative of `curve_features` by each coordinate, shape (d, 2) [-].

    `values` are those at the centre, then at a step of each coordinate up, then down.
    """
    k, d = len(posterior.law.parameters), len(values) // 2
    features = curve_features(posterior.law, values[:, :k], posterior.blocks)
    return np.nan_to_num((features[1 : d + 1] - features[d + 1 :]) / (2 * STEP))


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
