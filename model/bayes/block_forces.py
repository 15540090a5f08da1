# SPDX-License-Identifier: MIT
r"""Expected traction of blocks by one parameter vector, and its slopes, in a compiled loop.

The mean of the law over a block is that over its loads, slip following load by regression, plus
what the spread of slip at one load adds to it, by the points of `slip_rule` for the variance of
the slip that does not follow the measured load; the sum is scaled to that which does not follow
the true one. The load's rule has two points and the mean, variance and skewness of the block's
loads: a bump on a disc makes the loads skewed, and because peak slip depends on load the force
is curved in load.

Crosstalk puts the expected traction into the load, by the slope of force in load. With the
measured traction there, the density of the traction would have a Jacobian, and an error in that
is multiplied by the number of blocks. The two differ by :math:`c\,f_n`, crosstalk times the
slope in load, a five-hundredth, of the noise. Where slip varies, crosstalk makes the measured
load fall as traction rises though the true load stays: slip follows the true load by
:math:`c\,f_\kappa\,\omega^2` over the variance of load more than it follows the measured one.
True loads below 1e-9 N count as 1e-9 N.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_rule import LoadRule, load_rule
from model.bayes.averaging.slip_rule import POINTS, WEIGHTS, SlipRule, slip_rule
from model.compiled import borrowing
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw


class BlockTable(NamedTuple):
    """What the compiled loops take of n blocks; arrays of shape (n,).

    Attributes:
        slip: Mean slip [-].
        load: Mean measured load [N].
        shift: Sensitivity of slip to the relative error of the ratio of radii [-].
        variance: Variance of slip [-].
        slips: Points of the slip that does not follow load.
        loads: Points of load.
        traction: Measured traction [N].
        noise_size: Size of the noise over that of the usual run [-].
        slip_error: Variance of the block's own error of slip [-].
        load_error: Variance of its error of load [N^2].
    """

    slip: Array
    load: Array
    shift: Array
    variance: Array
    slips: SlipRule
    loads: LoadRule
    traction: Array
    noise_size: Array
    slip_error: Array
    load_error: Array


def block_table(blocks: SlipBlocks, *, sine: bool = False) -> BlockTable:
    """Compute what the compiled loops take of each block.

    Args:
        blocks: The block means.
        sine: Whether slip within blocks near zero slip is distributed as a sine wave is.
    """
    loads = load_rule(blocks)
    variance = np.maximum(blocks.slip_variance(), 1e-12)
    apart = np.maximum(variance - loads.slip_per_load**2 * loads.variance, 1e-12)
    # Copies of fields of `blocks`: one memory layout, for which loops are compiled once.
    return BlockTable(
        slip=np.array(blocks.slip),
        load=np.array(blocks.normal_force),
        shift=slip_per_radius_error(blocks.slip, blocks.definition),
        variance=variance,
        slips=slip_rule(blocks.slip, apart, sine=sine),
        loads=loads,
        traction=np.array(blocks.traction_force),
        noise_size=np.array(blocks.noise_size),
        slip_error=np.array(blocks.slip_error),
        load_error=np.array(blocks.load_error),
    )


def fill_forces(law: SlipLaw, values: Array, table: BlockTable, forces: Array) -> None:
    """Compute each block's expected measured traction and its slopes by one parameter vector.

    Args:
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (k + 11,).
        table: What `block_table` returns of the blocks.
        forces: Filled with the traction without run offset [N], its slope over slip across the
            spread of slip in the block [N] and over the true load [-], shape (3, n).
    """
    k = len(law.parameters)
    of_law = law.compiled_force(values[:k])
    cell = tuple(values[k : k + 6].tolist())
    loop = _loop(of_law.at_load, of_law.traction_over_load)
    loop(of_law.constants, of_law.driving, of_law.braking, cell, table, forces)


@cache
def _loop(at_load: Callable, traction_over_load: Callable) -> Callable[..., None]:
    """Return the loop over blocks that is compiled for a law's equations; see `fill_forces`.

    It takes constants and sides of the law's `CompiledForce`, the load cell's four parameters and
    those of radii and rolling resistance, the table and the forces.
    """

    def fill(constants, driving, braking, cell, table, forces):
        g_t, g_n, b_n, c, epsilon, c_r = cell

        def true(load):  # a load cell's bias can push the lightest loads through zero
            return max((1.0 + g_n) * load - b_n, 1e-9)

        def force(slip, load, coefficients):
            m, h = driving if slip >= 0.0 else braking
            over_load = m * traction_over_load(h * slip, *coefficients) - c_r
            return (1.0 + g_t) * true(load) * over_load

        slips, loads = table.slips, table.loads
        for j in range(len(table.slip)):
            middle = table.slip[j] - epsilon * table.shift[j]
            load = table.load[j]
            coefficients = at_load(true(load), constants)
            centre = force(middle, load, coefficients)
            slope = bend = 0.0
            for pair in range(slips.first[j], slips.last[j]):
                above = force(middle + POINTS[pair] * slips.sd[j], load, coefficients)
                below = force(middle - POINTS[pair] * slips.sd[j], load, coefficients)
                slope += WEIGHTS[pair] * POINTS[pair] / slips.sd[j] * (above - below)
                bend += WEIGHTS[pair] * (above - 2.0 * centre + below)
            forces[0, j], forces[1, j], forces[2, j] = bend, slope, centre
        # A loop of its own, since these slips depend on the slope: a processor computes ahead.
        for j in range(len(table.slip)):
            middle = table.slip[j] - epsilon * table.shift[j]
            load, light, heavy = table.load[j], loads.light[j], loads.heavy[j]
            bend, slope, centre = forces[0, j], forces[1, j], forces[2, j]
            at_light, at_heavy = at_load(true(light), constants), at_load(true(heavy), constants)
            heavier = force(middle, heavy, at_heavy)
            per_load = loads.slip_per_load[j] + c * slope * table.variance[j] / loads.followed[j]
            at_one_load = max(table.variance[j] - per_load**2 * loads.variance[j], 0.0)
            lower = force(middle + per_load * (light - load), light, at_light)
            upper = force(middle + per_load * (heavy - load), heavy, at_heavy)
            mean = lower + loads.heavy_share[j] * (upper - lower)
            mean += at_one_load / slips.sd[j] ** 2 * bend
            load_slope = (heavier - centre) / ((heavy - load) * (1.0 + g_n))
            forces[0, j] = mean + load_slope * c * mean
            forces[2, j] = load_slope

    # numba names the files of its cache by this: each law has its own.
    fill.__qualname__ = f"fill_{traction_over_load.__name__}"
    return borrowing(fill)
