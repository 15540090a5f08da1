# SPDX-License-Identifier: MIT
"""Traction by the walk's slip ratio: the thesis's Magic Formula, or any other law as a table."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.slip.definition import SlipDefinition, require_definition
from model.slip.law import SlipLaw, Values
from model.slip.magic_formula import MagicFormula, curvature_from_peak, magic_formula
from model.slip.sided import middle_curve
from model.walk.slip import Slip
from model.walk.traction import TractionTable, VelocityCoulomb, law_table
from model.walk.traction_lookup import table_value


class Traction(NamedTuple):
    """A slip law for the thesis's compiled loop: Magic Formula coefficients, or a table.

    Attributes:
        exact: Whether the Magic Formula with these four coefficients is used instead of the table.
        B: Stiffness factor [-].
        C: Shape factor [-].
        friction: Peak traction over load, D / Fn [-].
        peak_slip_per_load: Slip of the peak over load, x_m / Fn [1/N].
        table: Traction over load, for every other law.
    """

    exact: bool
    B: float
    C: float
    friction: float
    peak_slip_per_load: float
    table: TractionTable


# Beside exact coefficients the table is never looked up; `by_velocity` is read all the same.
_NO_TABLE = VelocityCoulomb(1.0).table(weight=1.0)._replace(by_velocity=False)

THESIS_TRACTION = Traction(True, 34.34, 1.564, 0.3798, 0.0066, _NO_TABLE)  # Listing A.20


def slip_traction(slip: Slip, *, weight: float) -> Traction:
    """Convert a slip law of a walk to the form that the thesis's model takes.

    Args:
        slip: The slip law.
        weight: Weight of the robot [N].

    Raises:
        DefinitionMismatch: The curve's slip definition is not `material`.
        DomainError: The law loses its shape at these loads.
    """
    if isinstance(slip.law, VelocityCoulomb):
        return table_traction(slip.law.table(weight=weight))
    require_definition(slip.law.definition, SlipDefinition.MATERIAL)
    return law_traction(slip.law.law, slip.law.values, weight=weight)


def law_traction(law: SlipLaw, values: Values, *, weight: float) -> Traction:
    """Convert a slip law and its values to the form of the thesis's model.

    The thesis hands its walk's slip ratio, Eq. (4-31), to a curve fitted to the rig's, Eq. (4-44),
    without conversion, and so does this model: see `docs/thesis-model.md`.

    Args:
        law: The slip law. A Magic Formula with curvature "peak" and without load sensitivity, as
            the thesis has it, is evaluated exactly; other laws are tabulated by `law_table`.
        values: Parameter values of the law, shape (k,).
        weight: Weight of the robot, which sets the range of tabulated loads [N].

    Raises:
        DomainError: A law that is tabulated loses its shape at these loads.
    """
    law, values = middle_curve(law, values)
    if isinstance(law, MagicFormula) and law.curvature == "peak" and not law.load_sensitivity:
        K, C, friction, peak_slip = (float(np.asarray(value)) for value in values)
        return Traction(True, K / (C * friction), C, friction, peak_slip, _NO_TABLE)
    return table_traction(law_table(law, values, weight=weight))


def table_traction(table: TractionTable) -> Traction:
    """Wrap a tabulated law for the thesis's model.

    A law by slip velocity gets v_R - v_C, or v_T - v_H on the toe, over its scale (`find_slip`).
    """
    return Traction(False, 0.0, 2.0, 0.0, 0.0, table)


@compiled
def magic_force(traction, kappa, load):
    """Compute the Magic Formula's force with its curvature from the peak, Eq. (4-23), (4-27) [N].

    It equals `model.slip.MagicFormula` and has the same limit at vanishing load: E tends to minus
    infinity there, and the force to that of saturation if slip stays finite, or to zero.

    Args:
        traction: The coefficients.
        kappa: Slip ratio [-].
        load: Normal force [N].
    """
    B, C, x_m = traction.B, traction.C, traction.peak_slip_per_load * load
    if B * x_m < 1e-100:  # E would be infinite
        return 0.0
    E = curvature_from_peak(B, C, x_m)
    return magic_formula(kappa, B, C, traction.friction * load, E)


@compiled
def traction_force(traction, kappa, load):
    """Compute the traction force of a leg; it has the sign of kappa, and is zero without load [N].

    Args:
        traction: The slip law: the Magic Formula with its coefficients if `exact`, else its table.
        kappa: Slip ratio, or slip velocity over `speed_scale` if the table is `by_velocity` [-].
        load: Normal force [N].
    """
    if load <= 0.0:
        return 0.0
    if traction.exact:
        return magic_force(traction, kappa, load)
    return np.sign(kappa) * load * table_value(traction.table, load, abs(kappa))


@compiled
def load_derivative(traction, kappa, load, force):
    """Compute the derivative of `traction_force` with respect to load, by a forward difference [-].

    Args:
        traction: The slip law.
        kappa: Slip ratio, or slip velocity over `speed_scale` if the table is `by_velocity` [-].
        load: Normal force [N].
        force: `traction_force` at this load [N].
    """
    step = 1e-6 * load + 1e-9
    return (traction_force(traction, kappa, load + step) - force) / step


def paired_sum(traction_force: Array) -> Array:
    """Sum successive samples of traction in pairs, as for the net force of Fig. 5-19.

    The thesis's traction changes sign at every step; the sum of a pair is what it calls the net
    force. It is twice the mean. As in the listing, the first sample is left out and pairs start
    with the second.

    Args:
        traction_force: Traction forces over time, shape (n, ...) [N].

    Returns:
        Sums of pairs, shape ((n - 1) // 2, ...) [N].
    """
    pairs = (len(traction_force) - 1) // 2
    return traction_force[1 : 2 * pairs : 2] + traction_force[2 : 2 * pairs + 1 : 2]
