# SPDX-License-Identifier: MIT
"""Forces of the slip laws for compiled loops: each lane has its own parameter values.

The functions are those of `magic_formula`, `brush` and `coulomb_stribeck`, and so are the results
but for rounding.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from model.arrays import Array
from model.compiled import inlined
from model.slip.brush import Brush
from model.slip.coulomb import CoulombStribeck
from model.slip.elementary import arctan, exp_of, log_of, minus_arctan, sin_half_turn
from model.slip.lanes import row, select, size
from model.slip.law import SlipLaw
from model.slip.magic_formula import MagicFormula
from model.slip.sided import N_SIDES, SidedLaw, side_factors

MAGIC_PEAK: Final = 0  # the Magic Formula with E from the peak's position
MAGIC: Final = 1  # the Magic Formula with E given
BRUSH: Final = 2  # from here on coefficients do not depend on load
COULOMB: Final = 3
ROWS: Final = 9
"""Number of coefficients of any law, in the first rows of a lane's values."""
FRICTION_FACTOR: Final = 7
SLIP_FACTOR: Final = 8


@dataclass(frozen=True)
class LaneLaw:
    """A slip law's kind and coefficients for many parameter vectors, as `law_force` takes them.

    Attributes:
        kind: `MAGIC_PEAK`, `MAGIC`, `BRUSH` or `COULOMB`.
        sensitive: Whether friction and stiffness grow with powers of the load.
        reference: Load at which they have their parameters' values [N].
        sided: Whether driving and braking differ in friction and stiffness (`SidedLaw`).
        coefficients: Shape (`ROWS`, w). Row 0 is K. The next rows are, for the Magic Formula, C,
            mu, x_m/Fn or E, tan(pi/2C) and the exponents of mu and of K; for the brush model mu;
            for Coulomb's friction mu, q and kappa_s. Unused rows are 0. The last two are the
            factors on friction and on slip in driving; those in braking are their reciprocals.
    """

    kind: int
    sensitive: bool
    reference: float
    sided: bool
    coefficients: Array


def lane_law(law: SlipLaw, values: Array) -> LaneLaw | None:
    """Return a law's coefficients for compiled loops; None for a law that has none.

    Args:
        law: The slip law, of k parameters.
        values: Parameter values, shape (w, k).
    """
    if isinstance(law, SidedLaw):
        return _apart(lane_law(law.law, values[:, :-N_SIDES]), values[:, -N_SIDES:])
    columns = values.T
    if isinstance(law, MagicFormula):
        return _magic_formula(law, columns)
    if isinstance(law, Brush):
        return _law(BRUSH, *columns)
    if isinstance(law, CoulombStribeck):
        K, mu, *fall = columns
        return _law(COULOMB, K, mu, *(fall if law.stribeck else (np.ones_like(K),) * 2))
    return None


def _magic_formula(law: MagicFormula, columns: Array) -> LaneLaw:
    """Return the coefficients of a Magic Formula from its parameters, shape (k, w)."""
    K, C, mu = columns[:3]
    peak = law.curvature == "peak"
    shape = columns[3] if isinstance(law.curvature, str) else np.full_like(K, law.curvature)
    exponents = columns[-2:] if law.load_sensitivity else np.zeros((2, len(K)))
    kind = MAGIC_PEAK if peak else MAGIC
    found = _law(kind, K, C, mu, shape, np.tan(np.pi / (2 * C)), *exponents)
    return LaneLaw(kind, law.load_sensitivity, law.reference_load, False, found.coefficients)


def _apart(middle: LaneLaw | None, sides: Array) -> LaneLaw | None:
    """Return the middle curve's law with the two parameters of a `SidedLaw` set, shape (w, 2)."""
    if middle is None:
        return None
    coefficients = middle.coefficients.copy()
    coefficients[FRICTION_FACTOR], coefficients[SLIP_FACTOR] = side_factors(1.0, *sides.T)
    return replace(middle, sided=True, coefficients=coefficients)


def _law(kind: int, *rows: Array) -> LaneLaw:
    """Return a law from its first coefficients, shape (w,) each; the others are 0.

    It has no load sensitivity, and is the same in driving and braking (both factors are 1).
    """
    coefficients = np.zeros((ROWS, len(rows[0])))
    coefficients[: len(rows)] = rows
    coefficients[FRICTION_FACTOR:] = 1.0
    return LaneLaw(kind, False, 1.0, False, coefficients)


@inlined
def law_at_load(kind, sensitive, reference, A, load):
    """Compute the four coefficients that `law_at_slip` takes at one load.

    Args:
        kind: Kind of the law.
        sensitive: Whether friction and stiffness grow with powers of the load.
        reference: Load at which they have their parameters' values [N].
        A: Rows of values, the law's `ROWS` coefficients first.
        load: Normal force, positive [N].

    Returns:
        B, C, D and E of the Magic Formula, or the law's first four coefficients.
    """
    K, C, mu, E = row(A, 0), row(A, 1), row(A, 2), row(A, 3)
    if kind >= BRUSH:
        return K, C, mu, E
    if sensitive:
        ratio = log_of(load * (1.0 / reference))
        mu = mu * exp_of(row(A, 5) * ratio)
        K = K * exp_of(row(A, 6) * ratio)
    B = K / (C * mu)
    if kind == MAGIC_PEAK:
        Bx = B * (E * load)
        E = (Bx - row(A, 4)) / minus_arctan(Bx)
    return B, C, mu * load, E


@inlined
def law_at_slip(kind, at_load, slip, load):
    """Compute the traction of a slip law [N].

    Args:
        kind: Kind of the law.
        at_load: Coefficients of `law_at_load`.
        slip: Slip ratio [-].
        load: Normal force, positive [N].
    """
    if kind == BRUSH:
        return load * _brush(slip, at_load[0], at_load[1])
    if kind == COULOMB:
        return load * _coulomb(slip, at_load[0], at_load[1], at_load[2], at_load[3])
    B, C, D, E = at_load
    Bk = B * slip
    return D * sin_half_turn(C * arctan(Bk - E * minus_arctan(Bk)))


@inlined
def side_at_slip(sided, kind, A, at_load, slip, load):
    """Compute the traction of a slip law whose driving and braking may differ [N].

    Args:
        sided: Whether they differ; if not, this is `law_at_slip`.
        kind: Kind of the law.
        A: Rows of values, the law's `ROWS` coefficients first.
        at_load: Coefficients of `law_at_load`.
        slip: Slip ratio, a lane's own [-].
        load: Normal force, positive [N].
    """
    if not sided:
        return law_at_slip(kind, at_load, slip, load)
    m, h = row(A, FRICTION_FACTOR), row(A, SLIP_FACTOR)
    braking = slip + 0.0 * m < 0.0  # a float slip becomes `Lanes` where the law has lanes
    m, h = select(braking, 1.0 / m, m), select(braking, 1.0 / h, h)
    return m * law_at_slip(kind, at_load, slip * h, load)


@inlined
def _brush(sigma, K, mu):
    """Compute traction over load of the brush model; see `brush` [-]."""
    psi = K * size(sigma) / (3.0 * mu)
    psi = select(psi < 1.0, psi, 1.0)
    force = mu * psi * (3.0 - 3.0 * psi + psi * psi)
    return select(sigma + 0.0 * K < 0.0, -force, force)


@inlined
def _coulomb(kappa, K, mu, q, kappa_s):
    """Compute traction over load with a Stribeck drop; see `coulomb_stribeck` [-]."""
    kappa_c = 1.5 * mu / K
    u = kappa / kappa_c
    u = select(u < 1.0, u, 1.0)
    u = select(u > -1.0, u, -1.0)
    z = (size(kappa) - kappa_c) / kappa_s
    z = select(z > 0.0, z, 0.0)
    return mu * (0.5 * u * (3.0 - u * u)) * (q + (1.0 - q) * exp_of(-(z * z)))
