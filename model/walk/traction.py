# SPDX-License-Identifier: MIT
"""Traction over load for the walking models: any slip law, tabulated for a compiled loop."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded

from model.arrays import Array
from model.errors import DomainError
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition, convert_slip
from model.slip.law import SlipLaw, Values
from model.slip.sided import middle_curve

N_LOADS = 41  # rows 12 % of load apart: a table within a hundredth of its law's peak
LOAD_RANGE = (0.02, 2.0)  # of the robot's weight; loads outside take the nearest row
N_SLIPS = 257  # columns; cubic between them, far finer than a slip curve
LARGEST_SLIP = 1e4  # slip ratio of a dragged leg that hardly turns
FAR_OUT = 1e9  # slip ratio at which every law is saturated


class TractionTable(NamedTuple):
    r"""Traction over load :math:`\varphi(x, N)` on a grid, odd in x, for the compiled loop.

    Cubic Hermite in :math:`w = \operatorname{arsinh}(x / x_0)`, linear in the logarithm of load.
    It is a named tuple because numba accepts one directly.

    Attributes:
        log_load: Logarithm of each row's load, ascending, shape (m,) [log N].
        scale: Slip x_0 below which the grid is linear in slip [-].
        step: Distance of columns in w [-].
        phi: Traction over load, shape (m, n) [-].
        slope: Derivative of phi with respect to w, shape (m, n) [-].
        toe: Largest traction over load of a leg on its toe (if `by_velocity`, of every contact of
            the project's model), by load, shape (m,) [-].
        by_velocity: Whether x is slip velocity over `speed_scale` instead of a slip ratio.
        speed_scale: Slip velocity over which traction on a toe (or a velocity law) sets in, and
            least speed of the arc that a slip velocity is divided by [m/s].
        lateral_grip: Grip across the rolling direction of a leg over that along it [-].
        lateral_stiffness: Slip stiffness across the rolling direction over that along it [-].
    """

    log_load: Array
    scale: float
    step: float
    phi: Array
    slope: Array
    toe: Array
    by_velocity: bool
    speed_scale: float
    lateral_grip: float = 1.0
    lateral_stiffness: float = 1.0


@dataclass(frozen=True)
class VelocityCoulomb:
    r"""Coulomb friction by slip velocity, the `coulomb:MU:V` of the command line.

    .. math::
        F = \mu N \frac{v}{\sqrt{v^2 + v_0^2}}

    Attributes:
        friction: Friction coefficient mu [-].
        speed_scale: Slip velocity v_0 at which traction is 71 % of mu N [m/s].

    Raises:
        DomainError: Friction or velocity scale is not above zero.
    """

    friction: float
    speed_scale: float = 0.001

    def __post_init__(self) -> None:
        """Check that friction and velocity scale are positive."""
        if not (self.friction > 0 and self.speed_scale > 0):
            raise DomainError(
                f"friction is {self.friction:g} and its velocity scale {self.speed_scale:g} m/s; "
                "expected both above zero"
            )

    def table(self, *, weight: float) -> TractionTable:
        """Tabulate traction over load by slip velocity over v_0, for the compiled loop.

        Args:
            weight: Weight of the robot; the load of the table's only row, without effect on the
                traction over load [N].
        """
        scale, w = _grid(1.0)
        x = scale * np.sinh(w)
        phi = self.friction * x / np.sqrt(1 + x**2)
        slope = self.friction / (1 + x**2) ** 1.5 * scale * np.cosh(w)
        return TractionTable(
            np.log([weight]), scale, float(w[1]), phi[None], slope[None],
            np.array([self.friction]), True, self.speed_scale,
        )  # fmt: skip


def law_table(
    law: SlipLaw,
    values: Values,
    *,
    weight: float,
    definition: SlipDefinition | str = SlipDefinition.MATERIAL,
    speed_scale: float = 0.001,
) -> TractionTable:
    """Tabulate a slip law's traction over load by slip ratio and load, for the compiled loop.

    Loads are from 0.02 to 2 times the weight, one alone if traction is proportional to load. Slip
    ratios of the table are material ones from 0 to 10 000, |slip velocity| over the speed at which
    the leg's arc passes the contact; a law of another definition is evaluated at converted slip.
    The table is odd in slip: a `SidedLaw` is tabulated by its middle curve. A leg on its toe, which
    no rig has measured, has the law's traction at infinite slip.

    Args:
        law: The slip law.
        values: Parameter values of the law, shape (k,).
        weight: Weight of the robot, which sets the range of loads [N].
        definition: Slip definition that the values were fitted in.
        speed_scale: Slip velocity over which traction on a toe sets in, and least speed of the
            arc that a slip velocity is divided by [m/s].

    Raises:
        DomainError: The law loses its shape at a load from 0.02 to 2 times the weight, even if it
            is proportional to load (`SlipLaw.valid`).
        ValueError: The slip definition is unknown.
    """
    law, values = middle_curve(law, values)
    loads = weight * np.geomspace(*LOAD_RANGE, N_LOADS)
    valid = np.broadcast_to(law.valid(loads, values), loads.shape)
    if not valid.all():
        worst = float(loads[~valid][0])
        raise DomainError(
            f"at a load of {worst:g} N the curve of '{law.name}' has more than one peak or changes "
            f"sign; calibrate at {loads[0]:g} to {loads[-1]:g} N, the loads of a leg of this robot"
        )
    stiffness = float(np.max(law.slip_derivative(0.0, loads, values) / loads))
    peak = _peak(law, values, loads)
    scale, w = _grid(float(peak.max()) / stiffness)
    x = scale * np.sinh(w)
    definition = SlipDefinition(definition)
    if _proportional_to_load(law, values, loads):
        loads = loads[:1]
    kappa = x if definition is SlipDefinition.MATERIAL else _converted(x, definition)
    phi = law.force(kappa, loads[:, None], values) / loads[:, None]
    slope = _column_slopes(phi, float(w[1]))
    slope[:, 0] = law.slip_derivative(0.0, loads, values) / loads * scale
    saturated = law.force(FAR_OUT, loads, values) / loads
    return TractionTable(
        np.log(loads), scale, float(w[1]), phi, slope,
        saturated, False, speed_scale,
    )  # fmt: skip


def curve_table(curve: SlipCurve, *, weight: float) -> TractionTable:
    """Tabulate traction over load of a calibrated slip curve at its posterior mean by `law_table`.

    Args:
        curve: The slip curve.
        weight: Weight of the robot, which sets the range of loads [N].

    Raises:
        DomainError: As for `law_table`.
    """
    return law_table(curve.law, curve.values, weight=weight, definition=curve.definition)


def _proportional_to_load(law: SlipLaw, values: Values, loads: Array) -> bool:
    """Return whether traction over load is the same at all given loads, tested at six slips."""
    slips = np.array([0.001, 0.01, 0.03, 0.1, 0.3, 0.9])
    phi = np.asarray(law.force(slips, loads[:, None], values)) / loads[:, None]
    return np.allclose(phi, phi[0], rtol=1e-12, atol=0)


def _grid(curve_scale: float) -> tuple[float, Array]:
    """Return x_0, a tenth of the slip `curve_scale` at which a law bends, and the columns' w.

    w is evenly spaced from 0 to that of slip `LARGEST_SLIP`, shape (257,).
    """
    scale = 0.1 * curve_scale
    return scale, np.linspace(0, np.arcsinh(LARGEST_SLIP / scale), N_SLIPS)


def _converted(x: Array, definition: SlipDefinition) -> Array:
    """Convert material slips x >= 0, which may exceed 1, to another definition.

    From x = 1 on the result is that of just below 1, or x itself if that is larger.
    """
    # A leg dragged sideways can slip faster than its arc passes: there the law is saturated.
    below_one = convert_slip(np.minimum(x, 1 - 1e-9), SlipDefinition.MATERIAL, definition)
    return np.where(x < 1, below_one, np.maximum(x, below_one))


def _peak(law: SlipLaw, values: Values, loads: Array) -> Array:
    """Return traction over load at each load's peak slip, at `FAR_OUT` without a peak [-]."""
    at = np.minimum(law.peak_slip(loads, values), FAR_OUT)
    return np.asarray(law.force(at, loads, values)) / loads


def _column_slopes(phi: Array, step: float) -> Array:
    r"""Differentiate the cubic spline through each row of phi at its evenly spaced columns.

    Its slopes s solve :math:`s_{j-1} + 4 s_j + s_{j+1} = 3 (\varphi_{j+1} - \varphi_{j-1}) / h`. At
    both ends the third derivative is the same in the two outermost intervals ("not-a-knot"):
    :math:`s_0 + 2 s_1 = (-5 \varphi_0 + 4 \varphi_1 + \varphi_2) / 2 h`, and alike at the other.
    scipy's `CubicSpline` is the same, but takes longer to import than all tables to compute.

    Args:
        phi: Values, shape (m, n).
        step: Distance h of the columns.

    Returns:
        Slopes, shape (m, n).
    """
    d = np.diff(phi, axis=1) / step
    right = np.empty_like(phi)
    right[:, 1:-1] = 3 * (d[:, :-1] + d[:, 1:])
    right[:, 0] = 0.5 * (5 * d[:, 0] + d[:, 1])
    right[:, -1] = 0.5 * (5 * d[:, -1] + d[:, -2])
    bands = np.ones((3, phi.shape[1]))  # above, on and below the diagonal
    bands[1, 1:-1] = 4.0
    bands[0, 1] = bands[2, -2] = 2.0
    return np.ascontiguousarray(solve_banded((1, 1), bands, right.T).T)
