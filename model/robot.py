# SPDX-License-Identifier: MIT
"""The robot: hip positions, shape of the legs, mass and inertia."""

from dataclasses import dataclass, field

import numpy as np

from model.arrays import Array
from model.errors import DomainError

N_LEGS = 6
LEFT = (0, 2, 4)  # indices of legs 1, 3, 5
RIGHT = (1, 3, 5)  # indices of legs 2, 4, 6
GRAVITY = 9.81  # the listing's [m/s2]

HIP_X, HIP_Y = 0.097, 0.1156  # Listing A.1; the text's w/2 puts hip_y at 0.1256 m


def _source_hips() -> Array:
    """Return the hip positions of the thesis's robot, Listing A.1, shape (6, 3) [m]."""
    x, y = (HIP_X, HIP_X, 0.0, 0.0, -HIP_X, -HIP_X), (HIP_Y, -HIP_Y) * 3
    return np.column_stack([x, y, np.zeros(N_LEGS)])


@dataclass(frozen=True)
class Robot:
    """A rigid body on six massless legs, each an arc of a circle from its hip to its toe.

    The defaults are the thesis's robot, Listing A.1.

    Attributes:
        hips: Hip positions in the body frame by leg, shape (6, 3) [m].
        leg_radius: Radius of the arc [m].
        leg_arc: Angle of the arc; pi in the thesis's model, about 200 degrees on its robot [rad].
        mass: Mass of the body [kg].
        body_size: Length, width and height of the body, shape (3,) [m].
        inertia: Principal moments of inertia about x, y and z; those of a uniform cuboid of
            `body_size` when None, Eq. (4-9) [kg m2].
        leg_offset: True minus reported angle of each leg, shape (6,) [rad].

    Raises:
        DomainError: Mass, leg radius, a size of the body or a moment of inertia is not positive and
            finite, the arc is not from 90 to below 360 degrees, or an array has another shape or is
            not finite.
    """

    hips: Array = field(default_factory=_source_hips)
    leg_radius: float = 0.035
    leg_arc: float = np.pi
    mass: float = 2.17
    body_size: tuple[float, float, float] = (0.194, 0.2512, 0.069)
    inertia: tuple[float, float, float] | None = None
    leg_offset: Array = field(default_factory=lambda: np.zeros(N_LEGS))

    def __post_init__(self) -> None:
        """Convert hips and offsets to arrays; check shapes, signs and the range of the arc."""
        for name, shape in (("hips", (N_LEGS, 3)), ("leg_offset", (N_LEGS,))):
            values = np.ascontiguousarray(getattr(self, name), dtype=float)
            _require_shape(name, values, shape)
            object.__setattr__(self, name, values)
        _require_positive("mass", self.mass, "kg")
        _require_positive("leg_radius", self.leg_radius, "m")
        _require_shape("body_size", np.array(self.body_size), (3,))
        for side, size in zip(("length", "width", "height"), self.body_size, strict=True):
            _require_positive(f"the {side} in body_size", size, "m")
        if self.inertia is not None:
            _require_shape("inertia", np.array(self.inertia), (3,))
            for axis, moment in zip("xyz", self.inertia, strict=True):
                _require_positive(f"inertia about {axis}", moment, "kg m2")
        if not np.pi / 2 <= self.leg_arc < 2 * np.pi:
            raise DomainError(
                f"leg_arc is {np.degrees(self.leg_arc):g} degrees (legs.arc_deg of robot.toml); "
                "expected 90 to below 360 (a half circle is 180)"
            )

    @property
    def principal_inertia(self) -> Array:
        """Moments of inertia about x, y, z: given ones, or a cuboid's, shape (3,) [kg m2]."""
        return (
            cuboid_inertia(self.mass, self.body_size)
            if self.inertia is None
            else np.array(self.inertia)
        )

    @property
    def toe_beyond(self) -> float:
        """Angle of the arc beyond a half circle; negative for a shorter one [rad]."""
        return self.leg_arc - np.pi

    @property
    def track(self) -> float:
        """Mean y of the left hips minus mean y of the right hips [m]."""
        y = self.hips[:, 1]
        return float(y[list(LEFT)].mean() - y[list(RIGHT)].mean())


def cuboid_inertia(mass: float, size: tuple[float, float, float]) -> Array:
    r"""Compute the moments of inertia of a uniform cuboid, Eq. (4-9), shape (3,) [kg m2].

    .. math::
        I_{xx} = m (w^2 + h^2)/12, \quad I_{yy} = m (l^2 + h^2)/12, \quad I_{zz} = m (w^2 + l^2)/12

    Args:
        mass: Mass [kg].
        size: Length l, width w and height h [m].

    >>> cuboid_inertia(2.17, (0.194, 0.2512, 0.069)).round(5).tolist()
    [0.01227, 0.00767, 0.01822]
    """
    l, w, h = size  # noqa: E741 the thesis's symbol
    return mass / 12 * np.array([w**2 + h**2, l**2 + h**2, w**2 + l**2])


def _require_shape(name: str, values: Array, shape: tuple[int, ...]) -> None:
    """Raise `DomainError` unless an array has the expected shape and is finite."""
    if values.shape != shape:
        raise DomainError(f"{name} has shape {values.shape}; expected {shape}")
    if not np.isfinite(values).all():
        raise DomainError(f"{name} is {values.tolist()}; expected finite numbers")


def _require_positive(name: str, value: float, unit: str) -> None:
    """Raise `DomainError` unless a value is positive and finite."""
    if not (value > 0 and np.isfinite(value)):
        raise DomainError(f"{name} is {value:g} {unit}; expected more than zero, and finite")
