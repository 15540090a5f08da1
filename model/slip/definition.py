# SPDX-License-Identifier: MIT
"""Slip-ratio definitions and the conversions between them.

Every definition is a function of two speeds at the contact: v_l, at which the leg's material
passes the contact (r·omega), and v_g, at which the ground does (the forward speed). All are zero
without slip and positive when the leg's surface outruns the ground.
"""

import math
from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.errors import DefinitionMismatch, DomainError


class SlipDefinition(StrEnum):
    """Definition of a slip ratio: what the difference of the two surface speeds is divided by.

    v_l is the speed of the leg's surface at the contact, v_g that of the ground.

    Attributes:
        MATERIAL: (v_l - v_g) / v_l, Eq. (4-44): the rig's; Pacejka's theoretical slip. 1 when the
            leg spins on the spot, minus infinity when it is locked.
        TRAVEL: (v_l - v_g) / v_g, Eq. (4-29): tyre data. Infinite when the leg spins on the spot,
            -1 when it is locked.
        LARGER: (v_l - v_g) / max(v_l, v_g): soil bins. 1 when the leg spins on the spot, -1 when it
            is locked.
        MEAN: (v_l - v_g) / ((v_l + v_g)/2): slide-to-roll ratio of tribometers, creepage of rails.
            2 when the leg spins on the spot, -2 when it is locked.
    """

    MATERIAL = "material"
    TRAVEL = "travel"
    LARGER = "larger"
    MEAN = "mean"


def slip_ratio(
    speed_leg: ArrayLike, speed_ground: ArrayLike, definition: SlipDefinition | str
) -> Array:
    """Compute the slip ratio from the two surface speeds at the contact.

    Args:
        speed_leg: v_l = omega_l·r_l, Eq. (4-43) [m/s].
        speed_ground: v_g = omega_g·r_g, Eq. (4-43) [m/s].
        definition: Slip definition, which names the divisor; ValueError for an unknown name.

    Returns:
        Slip ratio [-]; where the divisor is zero infinite, or NaN if both speeds are zero.

    >>> slip_ratio(0.4, 0.3, "material").round(3), slip_ratio(0.4, 0.3, "travel").round(3)
    (np.float64(0.25), np.float64(0.333))
    """
    v_l, v_g = np.asarray(speed_leg, dtype=float), np.asarray(speed_ground, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (v_l - v_g) / _divisor(v_l, v_g, SlipDefinition(definition))


def _divisor(v_l: Array, v_g: Array, definition: SlipDefinition) -> Array:
    """Return the speed that a slip definition divides by, in the unit of both speeds."""
    return {
        SlipDefinition.MATERIAL: v_l,
        SlipDefinition.TRAVEL: v_g,
        SlipDefinition.LARGER: np.maximum(v_l, v_g),
        SlipDefinition.MEAN: (v_l + v_g) / 2,
    }[definition]


def _speeds(kappa: Array, definition: SlipDefinition) -> tuple[Array, Array]:
    """Return v_l and v_g that have given slip ratios, in the unit of the speed divided by.

    Where slip is infinite, that speed is 0 and the other one 1.
    """
    if definition is SlipDefinition.MEAN:
        return 1 + kappa / 2, 1 - kappa / 2
    larger = definition is SlipDefinition.LARGER
    by_leg = kappa >= 0 if larger else definition is SlipDefinition.MATERIAL
    infinite = np.isinf(kappa)
    divisor = np.where(infinite, 0.0, 1.0)
    other = np.where(infinite, 1.0, 1 + np.where(by_leg, -kappa, kappa))
    return np.where(by_leg, divisor, other), np.where(by_leg, other, divisor)


def convert_slip(
    slip: ArrayLike, source: SlipDefinition | str, target: SlipDefinition | str
) -> Array:
    """Convert slip ratios from one definition to another.

    By way of the two speeds: the slip ratios of a contact differ by what they are divided by.

    Args:
        slip: Slip ratio in `source`'s definition [-].
        source: Definition of `slip`.
        target: Definition of the result.

    Returns:
        Slip ratio in `target`'s definition, infinite at the limits named in `SlipDefinition`; NaN
        stays NaN [-].

    Raises:
        DomainError: The definitions differ and a slip ratio lies outside the range of `source`'s (a
            disc would turn backwards).
        ValueError: A definition's name is unknown.

    >>> float(convert_slip(0.5, "material", "travel"))
    1.0
    """
    source, target = SlipDefinition(source), SlipDefinition(target)
    kappa = np.asarray(slip, dtype=float)
    if source is target:
        return kappa
    _require_possible(kappa, source)
    v_l, v_g = _speeds(kappa, source)
    with np.errstate(divide="ignore", invalid="ignore"):
        # not v_l - v_g, which has lost the digits of a small slip
        scaled = kappa * _divisor(v_l, v_g, source)
        return np.where(np.isfinite(kappa), scaled, v_l - v_g) / _divisor(v_l, v_g, target)


def slip_per_radius_error(slip: ArrayLike, definition: SlipDefinition | str) -> Array:
    r"""Compute the sensitivity of a slip ratio to a relative error of the ratio of the radii [-].

    With :math:`v_g/v_l` taken too small by a factor :math:`1 + \varepsilon`, the true slip is the
    computed one less :math:`\varepsilon` times this, to first order: 1 - slip for material slip,
    1 + slip for travel slip, 1 - abs(slip) for the slip over the larger speed, 1 - slip^2/4 for
    that over the mean speed.

    Args:
        slip: Slip ratio in `definition` [-].
        definition: Slip definition; ValueError for an unknown name.
    """
    kappa = np.asarray(slip, dtype=float)
    definition = SlipDefinition(definition)
    return {
        SlipDefinition.MATERIAL: 1 - kappa,
        SlipDefinition.TRAVEL: 1 + kappa,
        SlipDefinition.LARGER: 1 - np.abs(kappa),
        SlipDefinition.MEAN: 1 - kappa**2 / 4,
    }[definition]


def walk_slip_from_material(slip: ArrayLike, leg_angle: ArrayLike) -> Array:
    r"""Convert the rig's slip ratio, Eq. (4-44), to the walk's, Eq. (4-31), for a rolling leg.

    .. math::
        \kappa_{walk} = \frac{\kappa_{rig}}{1 + \sin\theta - \kappa_{rig}}

    Eq. (4-31) divides by the hip-relative speed of the contact point, not by the material's flow
    through the contact, so the same contact has a different number there. Infinite where the slip
    is 1 + sin(theta).

    Args:
        slip: Material slip ratio, Eq. (4-44) [-].
        leg_angle: Leg angle theta, pi/2 when the toe points straight down [rad].

    Returns:
        The walk's slip ratio kappa_R [-].
    """
    kappa = np.asarray(slip, dtype=float)
    return kappa / (1 + np.sin(np.asarray(leg_angle, dtype=float)) - kappa)


def require_definition(found: SlipDefinition | str, expected: SlipDefinition | str) -> None:
    """Check that slip ratios have the expected definition.

    Args:
        found: Definition of the slip ratios.
        expected: Definition that the parameters were fitted with.

    Raises:
        DefinitionMismatch: The two definitions differ.
        ValueError: One of them is no name of a slip definition.
    """
    if SlipDefinition(found) is not SlipDefinition(expected):
        raise DefinitionMismatch(str(found), str(expected))


RANGES: Final[Mapping[SlipDefinition, tuple[float, float]]] = MappingProxyType({
    SlipDefinition.MATERIAL: (-math.inf, 1.0),
    SlipDefinition.TRAVEL: (-1.0, math.inf),
    SlipDefinition.LARGER: (-1.0, 1.0),
    SlipDefinition.MEAN: (-2.0, 2.0),
})  # fmt: skip
"""Least and largest slip ratio of each definition while both discs turn forward [-]."""


def is_possible(slip: ArrayLike, definition: SlipDefinition) -> NDArray[np.bool_]:
    """Return where a slip ratio is within its definition's range: both discs turn forward.

    NaN is within it. Noise may put a measured slip ratio outside.

    Args:
        slip: Slip ratio [-].
        definition: Its definition.

    >>> is_possible([0.5, 1.002], SlipDefinition.MATERIAL)
    array([ True, False])
    """
    kappa, (least, largest) = np.asarray(slip, dtype=float), RANGES[definition]
    return ~((kappa < least) | (kappa > largest))


def _require_possible(kappa: Array, definition: SlipDefinition) -> None:
    """Raise `DomainError` if a slip ratio lies outside its definition's range, NaN excepted."""
    impossible = ~is_possible(kappa, definition)
    if np.any(impossible):
        raise DomainError(
            f"slip ratio {kappa[impossible].flat[0]:.4g} is outside {RANGES[definition]}, all that "
            f"'{definition}' slip can be while both discs turn forward; check the definition or "
            "leave these rows out"
        )
