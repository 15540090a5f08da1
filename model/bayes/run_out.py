# SPDX-License-Identifier: MIT
r"""Run-out of the discs by angle: its first two harmonics, from the forces, and slip without them.

The radius of a disc at the contact is :math:`r + \sum_{k=1,2} a_k\cos k\theta + b_k\sin k\theta`.
Slip is computed from speeds and nominal radii; whatever drives and controllers do, true slip is
that less :math:`h\,(\delta_g - \delta_l)`, with :math:`\delta = (r(\theta) - r)/r` of either disc
and h as in `slip_per_radius_error`. So the residual of the traction is, to first order,

.. math::
    e = -f_\kappa h\,(\delta_g - \delta_l) + \text{what the law and the load cell are wrong by}
      + \text{noise},

linear in the eight coefficients. They are found by least squares, with their prior, on means of a
few samples: means over a turn have lost them, and what a run has throughout tells nothing of them.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.approximation import plain_starts
from model.bayes.autoregression import centred, memory_of, run_variances, whitened
from model.bayes.averaging.blocks import block_means
from model.bayes.checks.raw import raw_residuals
from model.bayes.drawing.laplace import Laplace, find_mode
from model.bayes.fit import CLEAR_WIN, not_identified
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw
from model.slip.rig_errors import RigErrors
from model.slip.samples import DiscAngles, SlipSamples

HARMONICS = (1, 2)
TURN = 0.3  # rad that a disc turns within a mean: 20 means a turn, 10 a period of the second
PASSES = 3  # of fitting the law, finding run-out, and taking it from the slip
SLOW = 20  # means, about a turn, over which slip is smoothed where only its level matters
MEMORY = 2  # means before, which noise follows
FOLDS = 10
BEYOND = 0.1  # of the stated run-out, left to harmonics beyond the second
COARSE = 1000  # blocks, of the fits of the curve
_STEP = 1e-3  # of a coordinate, whose prior has unit scale


@dataclass(frozen=True)
class DiscRunOut:
    """Run-out of one disc.

    Attributes:
        disc: "leg" or "ground".
        coefficients: a_1, b_1, a_2, b_2 of the radius at the contact, shape (4,) [m].
        sd: Their standard deviations, shape (4,) [m].
    """

    disc: str
    coefficients: Array
    sd: Array

    @property
    def amplitudes(self) -> tuple[float, float]:
        """Amplitude by which the radius varies once and twice a turn [m]."""
        once, twice = np.hypot(self.coefficients[::2], self.coefficients[1::2])
        return float(once), float(twice)

    @property
    def amplitude_sd(self) -> tuple[float, float]:
        """Standard deviations of the amplitudes, the larger of both coefficients' [m]."""
        once, twice = np.maximum(self.sd[::2], self.sd[1::2])
        return float(once), float(twice)


@dataclass(frozen=True)
class RunOut:
    """Run-out of the discs whose angles are recorded, and whether the slip is corrected for it.

    Attributes:
        discs: The discs.
        gain: Log density of left-out runs with the correction less that without; 0 of one run [-].
        standard_error: Its standard error, from the scatter between runs [-].
        scatter: Scale of slip that the speeds do not show, once it is corrected [-].
    """

    discs: tuple[DiscRunOut, ...]
    gain: float
    standard_error: float
    scatter: float

    @property
    def used(self) -> bool:
        """Whether left-out runs are clearly predicted better, so that slip is corrected."""
        return self.gain > CLEAR_WIN * self.standard_error

    @property
    def coefficients(self) -> Array:
        """Coefficients of all discs, shape (4·discs,) [m]."""
        return np.concatenate([disc.coefficients for disc in self.discs])


def find_run_out(
    samples: SlipSamples,
    law: SlipLaw,
    *,
    load_cell: LoadCell,
    rig_errors: RigErrors,
    rng: np.random.Generator,
) -> RunOut | None:
    """Estimate the run-out of the discs whose angles are recorded.

    Args:
        samples: The samples.
        law: The slip law, of which a curve is fitted to coarse blocks.
        load_cell: Prior knowledge of the load cell.
        rig_errors: Prior knowledge of the rig, with the standard deviation of the coefficients.
        rng: Source of randomness of the fits of the curve.

    Returns:
        The run-out; None without angles, with a stated run-out of 0, or if `_system` is None.
    """
    angles = samples.angles
    if angles is None or rig_errors.run_out <= 0:
        return None
    length = _length(samples, angles)
    found, starts = None, None
    coefficients = np.zeros(4 * len(_recorded(angles)))
    for _ in range(PASSES):
        corrected = _corrected(samples, coefficients)
        posterior = _posterior(corrected, law, load_cell, rig_errors)
        starts = plain_starts(corrected, posterior, rng)[:2] if starts is None else starts
        curve = find_mode(posterior.log_density, starts)
        starts = np.vstack([curve.mode, starts[-2:]])  # from the last mode alone a search may stall
        system = _system(corrected, posterior, curve, length)
        if system is None:
            return None
        found = _solved(system, coefficients, rig_errors.run_out)
        coefficients = found.mean
    if found is None:
        return None
    discs = tuple(
        DiscRunOut(name, found.mean[4 * i : 4 * i + 4], found.sd[4 * i : 4 * i + 4])
        for i, (name, _, _) in enumerate(_recorded(angles))
    )
    return RunOut(discs, found.gain, found.standard_error, _remaining(angles, discs, rig_errors))


def without_run_out(samples: SlipSamples, found: RunOut) -> SlipSamples:
    """Return samples whose slip is that of the radii at the contact.

    Args:
        samples: The samples, with the angles of the discs.
        found: The run-out of these discs.
    """
    return _corrected(samples, found.coefficients)


def _corrected(samples: SlipSamples, coefficients: Array) -> SlipSamples:
    """Correct slip for run-out of the given coefficients, shape (m,) [m], to first order."""
    return replace(samples, slip=samples.slip + _waves(samples, samples.slip) @ coefficients)


def _recorded(angles: DiscAngles) -> list[tuple[str, Array, float]]:
    """Return name, angles, and signed derivative of relative radius by radius of recorded discs."""
    both = (
        ("leg", angles.leg, 1 / angles.radius_leg),
        ("ground", angles.ground, -1 / angles.radius_ground),
    )
    return [(name, angle, per) for name, angle, per in both if angle is not None]


def _waves(samples: SlipSamples, slip: Array) -> Array:
    """Compute the derivative of true slip by each coefficient, (n, m); (n, 0) if none [1/m]."""
    if samples.angles is None:
        return np.zeros((len(samples), 0))
    lever = slip_per_radius_error(slip, samples.definition)
    return np.column_stack([
        per * lever * wave(k * angle)
        for _, angle, per in _recorded(samples.angles)
        for k in HARMONICS
        for wave in (np.cos, np.sin)
    ])  # fmt: skip


def _length(samples: SlipSamples, angles: DiscAngles) -> int:
    """Return in how many samples the disc of the larger 90 % quantile of speed turns `TURN`."""
    inside = np.diff(samples.run) == 0
    fastest = 0.0
    for _, angle, _ in _recorded(angles):
        step = np.abs((np.diff(angle)[inside] + np.pi) % (2 * np.pi) - np.pi)
        fastest = max(fastest, float(np.quantile(step, 0.9)) if len(step) else 0.0)
    return max(1, int(TURN / fastest)) if fastest > 0 else len(samples)  # all if none turns


@dataclass(frozen=True)
class _System:
    """Linear equations of the residuals of means, n of them: waves in m columns, others in q.

    `steepness` is the relative standard deviation of the curve's slope, which scales all waves.
    """

    residual: Array
    waves: Array
    others: Array
    run: NDArray[np.intp]
    steepness: float


def _posterior(
    samples: SlipSamples, law: SlipLaw, load_cell: LoadCell, rig_errors: RigErrors
) -> SlipPosterior:
    """Return the posterior of a curve by coarse blocks."""
    blocks = block_means(samples, max(1, len(samples) // COARSE))
    priors = default_priors(law, blocks, load_cell, rig_errors)
    return SlipPosterior(blocks, law, priors, not_identified(blocks))


def _system(
    samples: SlipSamples, posterior: SlipPosterior, curve: Laplace, length: int
) -> _System | None:
    """Build the equations on means of `length` samples; None if no run has over `MEMORY` + 1."""
    blocks = block_means(samples, length)
    enough = np.bincount(blocks.run)[blocks.run] > MEMORY + 1
    if not enough.any():
        return None
    starts = np.cumsum(blocks.count) - blocks.count
    means = SlipSamples(
        np.add.reduceat(samples.slip, starts) / blocks.count, blocks.normal_force,
        blocks.traction_force, blocks.run, blocks.run_names, blocks.definition,
    )  # fmt: skip
    values, law = posterior.values(curve.mode[None])[0], posterior.law
    residual, _ = raw_residuals(means, law, values)
    # Of a slip without noise and run-out: with them in both, residual and slope are correlated.
    slow = block_means(samples, SLOW * length)
    level = np.repeat(slow.slip, slow.count)
    smooth = replace(means, slip=level[starts])
    beside, slope = raw_residuals(smooth, law, values)
    smooth = replace(smooth, traction_force=smooth.traction_force - beside)
    waves = np.add.reduceat(_waves(samples, level), starts) / blocks.count[:, None]
    others, steepness = _unsure(smooth, posterior, curve)
    return _System(
        residual[enough], (slope[:, None] * waves)[enough], others[enough], blocks.run[enough],
        steepness,
    )  # fmt: skip


def _unsure(samples: SlipSamples, posterior: SlipPosterior, curve: Laplace) -> tuple[Array, float]:
    """Compute by how much the curve's uncertainty moves predicted forces, as d columns, (n, d) [N].

    They are the derivatives by coordinates times the Cholesky factor of the curve's covariance.
    Without them load cell errors would pass for run-out. Also: relative sd of the slope [-].
    """
    moved = curve.mode + np.vstack([np.zeros(len(curve.mode)), _STEP * np.eye(len(curve.mode))])
    each = [raw_residuals(samples, posterior.law, v) for v in posterior.values(moved)]
    residual, slope = (np.nan_to_num(np.array(of)) for of in zip(*each, strict=True))  # NaN: 0
    factor = np.linalg.cholesky(curve.covariance)
    steeper = (slope[1:] @ slope[0] / (slope[0] @ slope[0]) - 1) / _STEP
    return (residual[0] - residual[1:]).T / _STEP @ factor, float(np.linalg.norm(steeper @ factor))


@dataclass(frozen=True)
class _Solution:
    mean: Array  # of the coefficients, shape (m,) [m]
    sd: Array  # shape (m,) [m]
    gain: float  # as of `RunOut`
    standard_error: float  # of the gain


def _solved(system: _System, before: Array, prior_sd: float) -> _Solution:
    """Solve for the coefficients by generalised least squares, with their prior.

    Noise follows that of the means before, alike in all runs, and has a size of its own in each.

    Args:
        system: The equations, of samples that are corrected already.
        before: The coefficients by which they are corrected, shape (m,) [m].
        prior_sd: Standard deviation of each coefficient [m].
    """
    m = system.waves.shape[1]
    target = system.residual + system.waves @ before
    columns = np.column_stack([system.waves, system.others, target])
    memory, size = np.zeros(MEMORY), np.ones(int(system.run.max()) + 1)
    left, run = columns, system.run
    for _ in range(3):
        left, run = whitened(columns, system.run, memory)
        scaled = left / np.sqrt(size[run])[:, None]
        fit = np.linalg.lstsq(scaled[:, :-1], scaled[:, -1], rcond=1e-9)[0]
        rest = centred(columns[:, -1] - columns[:, :-1] @ fit, system.run)
        size = run_variances(left[:, -1] - left[:, :-1] @ fit, run, len(size))
        telling = np.bincount(system.run, np.sum(centred(system.waves, system.run) ** 2, axis=1))
        memory = memory_of(rest, system.run, telling / size**2, order=MEMORY)
    left, run = whitened(columns, system.run, memory)
    scaled = left / np.sqrt(size[run])[:, None]
    prior = np.append(np.full(m, prior_sd), np.ones(columns.shape[1] - m - 1))
    found = _with_prior(scaled, run, prior, m)
    return replace(found, sd=np.hypot(found.sd, system.steepness * found.mean))


def _with_prior(columns: Array, run: NDArray[np.intp], prior_sd: Array, m: int) -> _Solution:
    """Return the posterior of the waves' coefficients, and how it predicts left-out runs.

    Args:
        columns: Whitened waves, other columns, and target, shape (n, k + 1).
        run: Run of each row, shape (n,).
        prior_sd: Standard deviation of each column's coefficient, shape (k,).
        m: Number of waves.
    """
    starts = np.flatnonzero(np.diff(run, prepend=-1))
    by_run = np.split(columns, starts[1:])
    products = np.stack([part.T @ part for part in by_run])  # (runs, k + 1, k + 1)
    whole, prior = products.sum(axis=0), np.diag(prior_sd**-2)
    covariance = np.linalg.inv(prior + whole[:-1, :-1])
    mean = covariance @ whole[:-1, -1]
    told = products[:, :-1, -1] - products[:, :-1, :-1] @ mean
    scatter = np.diag(covariance @ (told.T @ told) @ covariance)
    # Student's t of as many degrees of freedom as runs tell: those on the steep part of the curve.
    each = np.diagonal(products, axis1=1, axis2=2)[:, :-1]
    runs = np.maximum(each.sum(axis=0) ** 2 / np.maximum((each**2).sum(axis=0), 1e-300), 3.0)
    sd = np.sqrt(np.maximum(np.diag(covariance), scatter) * runs / (runs - 2))
    everything, without = np.ones(len(mean), dtype=bool), np.arange(len(mean)) >= m
    folds, gains = min(FOLDS, len(starts)), np.zeros(len(starts))
    for fold in range(folds if folds > 1 else 0):
        out = np.arange(len(starts)) % folds == fold
        known = whole - products[out].sum(axis=0)
        own, other = (_fit_of(products[out], known, prior, of) for of in (everything, without))
        gains[out] = own - other
    return _Solution(
        mean[:m],
        np.minimum(sd[:m], prior_sd[:m]),
        float(gains.sum()),
        float(np.sqrt(len(gains)) * np.std(gains)),
    )


def _fit_of(products: Array, known: Array, prior: Array, used: NDArray[np.bool_]) -> Array:
    """Compute runs' log densities up to a constant, (runs,), by a fit to Gram matrix `known`."""
    mean = np.zeros(len(used))
    inside = np.ix_(used, used)
    mean[used] = np.linalg.solve((prior + known[:-1, :-1])[inside], known[:-1, -1][used])
    return products[:, :-1, -1] @ mean - 0.5 * np.einsum(
        "i,kij,j->k", mean, products[:, :-1, :-1], mean
    )


def _remaining(angles: DiscAngles, discs: tuple[DiscRunOut, ...], errors: RigErrors) -> float:
    """Return the sd of slip that corrected run-out makes, at most `errors.slip_scatter` [-]."""
    known = {disc.disc: float(np.sum(disc.sd**2)) for disc in discs}
    total = 0.0
    for name, radius in (("leg", angles.radius_leg), ("ground", angles.radius_ground)):
        square = errors.run_out**2
        total += 0.5 * (known[name] + BEYOND**2 * square if name in known else square) / radius**2
    return min(float(np.sqrt(total)), errors.slip_scatter)
