# SPDX-License-Identifier: MIT
"""Log likelihood of block means, compiled: several parameter vectors side by side in lanes.

The equations are those of `model.bayes.likelihood`, and so are the results but for rounding. One
loop goes through each run's blocks: it computes the expected traction of a block and updates the
Kalman filter, so that nothing is stored for each block and parameter vector.
"""

import math

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_rule import load_rule
from model.bayes.averaging.slip_rule import POINTS, WEIGHTS, slip_rule
from model.compiled import borrowing, inlined
from model.slip.definition import slip_per_radius_error
from model.slip.elementary import log_of
from model.slip.lane_force import ROWS, LaneLaw, law_at_load, side_at_slip
from model.slip.lanes import LANES, put, row, select

(
    GAIN_T, GAIN_N, BIAS, CROSSTALK, RADIUS, ROLLING, SCALE, SCATTER, FLOOR, RHO, TAU,
) = range(ROWS, ROWS + 11)  # fmt: skip
(
    LOAD, CENTRE, SPREAD, FIRST, LAST, LIGHT_LOAD, HEAVY_LOAD, DOWN, UP, HEAVY_SHARE, FOLLOW,
    ALONG_LOAD, SLIP_PER_LOAD, SHIFT, FORCE, OWN_ERROR, LOAD_ERROR, SIZE,
) = range(18)  # fmt: skip
"""Columns of `block_table`."""
LOG_2PI = math.log(2 * math.pi)


def block_table(blocks: SlipBlocks) -> Array:
    """Compute what the likelihood needs of each block, shape (n, 18).

    Columns, in the order of their names above: mean load and slip; standard deviation, first and
    last index of the block's `SlipRule`; light and heavy load of its `LoadRule`, each less the mean
    load, and the share of the heavy one; variance of slip over that of the load which it follows;
    variance of load over that of slip at a given load; slope of slip over load; sensitivity of slip
    to the ratio of radii; measured traction; variances of the slip's and the load's own error; size
    of the noise.
    """
    rule, slip, load = load_rule(blocks), blocks.slip, blocks.normal_force
    variance = np.maximum(blocks.slip_variance(), 1e-12)
    apart = np.maximum(variance - rule.slip_per_load**2 * rule.variance, 1e-12)
    points = slip_rule(slip, apart)
    return np.column_stack(
        [
            load, slip, points.sd, points.first.astype(float), points.last.astype(float),
            rule.light, rule.heavy, rule.light - load, rule.heavy - load, rule.heavy_share,
            variance / rule.followed, rule.variance / apart, rule.slip_per_load,
            slip_per_radius_error(slip, blocks.definition),
            blocks.traction_force, blocks.slip_error, blocks.load_error, blocks.noise_size,
        ]
    )  # fmt: skip


def lane_log_likelihood(blocks: SlipBlocks, law: LaneLaw, measurement: Array) -> Array:
    """Compute the log density of each run's block means; see `run_log_likelihood`.

    Args:
        blocks: The block means.
        law: Coefficients of the law for w parameter vectors.
        measurement: The 11 parameters of the measurement, shape (w, 11).

    Returns:
        Log density of each run, shape (w, n_runs).
    """
    w = len(measurement)
    groups = -(-w // LANES)
    values = np.concatenate([law.coefficients, measurement.T])
    padded = np.concatenate([values, np.repeat(values[:, -1:], groups * LANES - w, axis=1)], axis=1)
    rows = np.ascontiguousarray(padded.reshape(len(values), groups, LANES).swapaxes(0, 1))
    found = np.empty((groups, blocks.n_runs, LANES))
    _fill(
        law.kind, law.sensitive, law.reference, law.sided, rows, block_table(blocks),
        blocks.run_starts(), blocks.run_slip_error, np.zeros((1, LANES)), found,
    )  # fmt: skip
    return found.swapaxes(1, 2).reshape(groups * LANES, -1)[:w]


@borrowing
def _fill(kind, sensitive, reference, sided, rows, table, starts, run_slip_error, zero, found):
    """Fill the log densities `found`, shape (groups, n_runs, LANES); see `lane_log_likelihood`.

    State of the Kalman filter: the standardised noise z, AR(1) with unit variance; observation
    noise: the block's own errors of slip and load times the squared slopes. The filter is linear,
    so it whitens the residual and the three directions that a run shares (1 for the zero of
    traction, the slope for its slip error, the slope in load for the zero of load) together. With G
    their Gram matrix, b their products with the residual and D their variances, the quadratic form
    and determinant of the run's covariance follow from 1 + D G by the Woodbury identity.

    `rows` has shape (groups, values,
    LANES), `table` (n, 18), `starts` (n_runs + 1,), `run_slip_error` (n_runs,), `zero` (1, LANES).
    """
    for group in range(len(rows)):
        A, result = rows[group], found[group]
        rho, nothing = row(A, RHO), row(zero, 0)
        forget, q = rho * rho, row(A, SCALE) * row(A, SCALE)
        own = row(A, SCATTER) * row(A, SCATTER)
        for i in range(len(starts) - 1):
            m_r = m_1 = m_g = m_h = rr = r1 = rg = rh = log_determinant = nothing
            s11 = s1g = s1h = sgg = sgh = shh = nothing
            variance = nothing + 1.0
            for j in range(starts[i], starts[i + 1]):
                block = table[j]
                force, g, h = _predicted(kind, sensitive, reference, sided, A, block)
                s = row(A, FLOOR) * block[SIZE]
                sv = s * variance
                errors = g * g * (q * block[OWN_ERROR] + own) + h * h * block[LOAD_ERROR]
                total = _positive(s * sv + errors)
                weight = 1.0 / total
                e_r, e_1 = block[FORCE] - force - s * m_r, 1.0 - s * m_1
                e_g, e_h = g - s * m_g, h - s * m_h
                gain = sv * weight
                w_r, w_1, w_g, w_h = e_r * weight, e_1 * weight, e_g * weight, e_h * weight
                rr, r1, rg, rh = rr + e_r * w_r, r1 + e_r * w_1, rg + e_r * w_g, rh + e_r * w_h
                s11, s1g, s1h = s11 + e_1 * w_1, s1g + e_1 * w_g, s1h + e_1 * w_h
                sgg, sgh, shh = sgg + e_g * w_g, sgh + e_g * w_h, shh + e_h * w_h
                log_determinant = log_determinant + log_of(total)
                m_r = rho * (m_r + gain * e_r)
                m_1 = rho * (m_1 + gain * e_1)
                m_g = rho * (m_g + gain * e_g)
                m_h = rho * (m_h + gain * e_h)
                variance = forget * variance * (1.0 - gain * s) + (1.0 - forget)
            of_zero, shared = row(A, TAU) * row(A, TAU), q * run_slip_error[i]
            # The rows of 1 + D G, and the product of its inverse with D b by cofactors.
            a_1, a_g, a_h = 1.0 + of_zero * s11, of_zero * s1g, of_zero * s1h
            b_1, b_g, b_h = shared * s1g, 1.0 + shared * sgg, shared * sgh
            c_1, c_g, c_h = of_zero * s1h, of_zero * sgh, 1.0 + of_zero * shh
            f_1, f_g, f_h = b_g * c_h - b_h * c_g, b_h * c_1 - b_1 * c_h, b_1 * c_g - b_g * c_1
            determinant = a_1 * f_1 + a_g * f_g + a_h * f_h
            # It is at least 1, unless the numbers are beyond what rounding leaves of them.
            determinant = select(determinant > 0.5, determinant, math.nan)
            y_1, y_g, y_h = of_zero * r1, shared * rg, of_zero * rh
            x_1 = f_1 * y_1 + (a_h * c_g - a_g * c_h) * y_g + (a_g * b_h - a_h * b_g) * y_h
            x_g = f_g * y_1 + (a_1 * c_h - a_h * c_1) * y_g + (a_h * b_1 - a_1 * b_h) * y_h
            x_h = f_h * y_1 + (a_g * c_1 - a_1 * c_g) * y_g + (a_1 * b_g - a_g * b_1) * y_h
            # Where noise is far below everything else, the difference cancels to rounding errors
            # of either sign; these are its lower bound.
            quadratic = rr - (r1 * x_1 + rg * x_g + rh * x_h) / determinant
            least = 1e-14 * rr
            quadratic = select(quadratic < least, least, quadratic)
            blocks = starts[i + 1] - starts[i]
            density = quadratic + log_determinant + log_of(determinant) + blocks * LOG_2PI
            put(result, i, -0.5 * density)


@inlined
def _positive(variance):
    """Return a variance, NaN where rounding or overflow has left none that is positive."""
    return select(variance > 0.0, variance, math.nan)


@inlined
def _predicted(kind, sensitive, reference, sided, A, block):
    """Compute a block's expected traction and its slopes in slip and load; as `predict_blocks`."""
    g_t, g_n, b_n = 1.0 + row(A, GAIN_T), 1.0 + row(A, GAIN_N), row(A, BIAS)
    shift, c_r = row(A, RADIUS) * block[SHIFT], row(A, ROLLING)
    load = _true_load(g_n, b_n, block[LOAD])
    at_load = law_at_load(kind, sensitive, reference, A, load)
    middle = block[CENTRE] - shift
    centre = g_t * (side_at_slip(sided, kind, A, at_load, middle, load) - c_r * load)
    slope = bend = centre * 0.0
    for pair in range(int(block[FIRST]), int(block[LAST])):
        away = POINTS[pair] * block[SPREAD]
        above = g_t * (side_at_slip(sided, kind, A, at_load, middle + away, load) - c_r * load)
        below = g_t * (side_at_slip(sided, kind, A, at_load, middle - away, load) - c_r * load)
        slope = slope + (above - below) * (WEIGHTS[pair] * POINTS[pair])
        bend = bend + (above - 2.0 * centre + below) * WEIGHTS[pair]
    slope = slope * (1.0 / block[SPREAD])
    c = row(A, CROSSTALK)
    per_load = block[SLIP_PER_LOAD] + c * slope * block[FOLLOW]
    measured = block[SLIP_PER_LOAD]
    more = (per_load * per_load - measured * measured) * block[ALONG_LOAD]
    at_one_load = _at_least_zero(1.0 - more)
    load = _true_load(g_n, b_n, block[LIGHT_LOAD])
    at_load = law_at_load(kind, sensitive, reference, A, load)
    slip = middle + per_load * block[DOWN]
    light = g_t * (side_at_slip(sided, kind, A, at_load, slip, load) - c_r * load)
    load = _true_load(g_n, b_n, block[HEAVY_LOAD])
    at_load = law_at_load(kind, sensitive, reference, A, load)
    slip = middle + per_load * block[UP]
    heavy = g_t * (side_at_slip(sided, kind, A, at_load, slip, load) - c_r * load)
    heavier = g_t * (side_at_slip(sided, kind, A, at_load, middle, load) - c_r * load)
    mean = light + block[HEAVY_SHARE] * (heavy - light)
    mean = mean + at_one_load * bend
    load_slope = (heavier - centre) * (1.0 / block[UP]) / g_n
    return mean + load_slope * c * mean, slope, load_slope


@inlined
def _at_least_zero(share):
    """Return a share, 0 where it is negative."""
    return select(share > 0.0, share, 0.0)


@inlined
def _true_load(g_n, b_n, measured):
    """Compute the true load of a measured one, at least 1e-9 N [N]."""
    load = g_n * measured - b_n
    return select(load > 1e-9, load, 1e-9)
