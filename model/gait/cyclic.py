# SPDX-License-Identifier: MIT
"""Periodic leg angles with two speeds, one on the ground and one in flight."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError
from model.gait.stance import Intervals, event_intervals, require_stance_angles
from model.robot import N_LEGS

_KINK = 1e-11  # of a period: how near to a change of speed a time is taken to be at it
_BY_LEG = ("touchdown", "liftoff", "ground_time", "flight_time", "phase", "pause", "offset")


@dataclass(frozen=True, eq=False)
class CyclicReference:
    r"""Periodic leg angles: one speed from touchdown to lift-off, another to the next touchdown.

    .. math::
        \theta(t) = 2\pi k + \begin{cases}
            \theta_{TD} + \dot\theta_g u & u < \tau_g \\
            \theta_{LO} & \tau_g \le u < \tau_g + \tau_w \\
            \theta_{LO} + \dot\theta_f (u - \tau_g - \tau_w) & \text{else}
        \end{cases} \qquad
        \dot\theta_g = \frac{\theta_{LO} - \theta_{TD}}{\tau_g}, \quad
        \dot\theta_f = \frac{2\pi - (\theta_{LO} - \theta_{TD})}{\tau_f - \tau_w}

    with u the time since the leg's last touchdown, its k-th: Eq. (2-20) to (2-22), with a pause
    tau_w. With a phase from 0 to below 1 the last touchdown up to time zero has k = 0.
    `dataclasses.replace` gives any gait pauses and offsets.

    Every array has one entry a leg, and a number stands for all legs. The robot has six; the class
    takes any number of legs.

    Attributes:
        touchdown: Touchdown angles, shape (n,) [rad].
        liftoff: Lift-off angles, beyond touchdown by less than a turn, shape (n,) [rad].
        ground_time: Times tau_g from touchdown to lift-off, shape (n,) [s].
        flight_time: Times tau_f from lift-off to touchdown, the pause included, shape (n,) [s].
        phase: Share of the period by which each leg is past touchdown at time zero; 1 more puts
            the leg a turn ahead, shape (n,) [-].
        inner: Indices of the legs on the inner side of a turn; only stored. Empty where no side was
            named; `tripod_reference` sets the side of `direction` for a straight walk too.
        pause: How long, tau_w, a leg waits at lift-off before its flight, shape (n,) [s].
        offset: Angle added to each leg's angle of the equation above, shape (n,) [rad].

    Raises:
        DomainError: Shapes do not match, a value is not finite, lift-off does not exceed touchdown
            by less than a turn, a time is not positive, legs differ in period, or a pause is
            negative or leaves no time to fly.
    """

    touchdown: Array
    liftoff: Array
    ground_time: Array
    flight_time: Array
    phase: Array
    inner: tuple[int, ...] = ()
    pause: Array | float = 0.0
    offset: Array | float = 0.0

    def __post_init__(self) -> None:
        """Broadcast numbers to all legs; check that angles and times describe a periodic gait."""
        values = [np.atleast_1d(np.asarray(getattr(self, name), dtype=float)) for name in _BY_LEG]
        try:
            full = np.broadcast_arrays(*values)
        except ValueError as fault:
            shapes = ", ".join(f"{n} {v.shape}" for n, v in zip(_BY_LEG, values, strict=True))
            raise DomainError(f"shapes do not match: {shapes}; expected one entry a leg") from fault
        for name, value in zip(_BY_LEG, full, strict=True):
            if value.ndim != 1 or not np.isfinite(value).all():
                raise DomainError(f"{name} is {value}; expected one finite number a leg")
            object.__setattr__(self, name, value.copy())
        require_stance_angles(self.touchdown, self.liftoff)
        self._require_times()

    def _require_times(self) -> None:
        """Raise `DomainError` unless times are positive, pauses fit and all periods are equal."""
        pause = np.asarray(self.pause)
        for leg in range(self.n_legs):
            ground, flight, wait = self.ground_time[leg], self.flight_time[leg], pause[leg]
            if not (ground > 0 and flight > 0):
                raise DomainError(
                    f"leg {leg + 1} spends {ground:g} s on the ground and {flight:g} s in flight; "
                    "expected both more than zero: raise the gait's cycle, ground or flight time"
                )
            if not 0 <= wait < flight:
                raise DomainError(
                    f"leg {leg + 1} pauses for {wait:g} s of its {flight:g} s in flight; "
                    "expected at least zero, and less than the flight"
                )
            if not np.isclose(ground + flight, self.period, rtol=1e-9):
                raise DomainError(
                    f"leg {leg + 1} has a period of {ground + flight:.12g} s and leg 1 of "
                    f"{self.period:.12g} s; expected the same ground plus flight time for all"
                )

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return len(self.phase)

    @property
    def period(self) -> float:
        """Cycle time tau_c, in which every leg turns by 2 pi: ground plus flight time [s]."""
        return float(self.ground_time[0] + self.flight_time[0])

    @property
    def stance_angle(self) -> Array:
        """Lift-off minus touchdown angles, shape (n,) [rad]."""
        return self.liftoff - self.touchdown

    @property
    def ground_speed(self) -> Array:
        """Leg speeds on the ground, shape (n,) [rad/s]."""
        return self.stance_angle / self.ground_time

    @property
    def flight_speed(self) -> Array:
        """Leg speeds in flight after the pause, shape (n,) [rad/s]."""
        return (2 * np.pi - self.stance_angle) / (self.flight_time - self.pause)

    def mirrored(self) -> "CyclicReference":
        """Return the mirror image of the gait, left and right legs of six exchanged.

        Raises:
            DomainError: The gait does not have six legs.
        """
        if self.n_legs != N_LEGS:
            raise DomainError(f"{self.n_legs} legs have no mirror image; expected {N_LEGS}")
        other = [1, 0, 3, 2, 5, 4]
        swapped = {name: getattr(self, name)[other] for name in _BY_LEG}
        return replace(self, **swapped, inner=tuple(sorted(other[leg] for leg in self.inner)))

    def angles(self, t: ArrayLike) -> Array:
        """Compute the unwrapped leg angles, `offset` included, at times t [s].

        Shape (m, n) [rad] for m times, (1, n) for a number.
        """
        turns, since = self._since_touchdown(t)
        ground = self.touchdown + self.ground_speed * since
        flown = np.maximum(since - self.ground_time - self.pause, 0.0)
        flight = self.liftoff + self.flight_speed * flown
        within = np.where(since < self.ground_time, ground, flight)
        return 2 * np.pi * turns + within + self.offset

    def speeds(self, t: ArrayLike) -> Array:
        """Compute leg speeds at times t [s], at a kink those after it, shape (m, n) [rad/s]."""
        _, since = self._since_touchdown(t)
        flies = since >= self.ground_time + self.pause
        stands = since < self.ground_time
        return np.where(stands, self.ground_speed, np.where(flies, self.flight_speed, 0.0))

    def stance_intervals(self, span: tuple[float, float]) -> Intervals:
        """Compute when each leg, by its angle less `offset`, is from touchdown to lift-off.

        Args:
            span: Start and end; intervals are cut there [s].

        Returns:
            One array of rows (start, end), shape (k, 2), for each leg [s].
        """
        first = np.floor(span[0] / self.period + self.phase.min())
        last = np.floor(span[1] / self.period + self.phase.max())
        down = (np.arange(first, last + 1)[:, None] - self.phase) * self.period
        return event_intervals(down, down + self.ground_time, span)

    def touchdowns(self, span: tuple[float, float]) -> list[tuple[Array, Array]]:
        """Compute when each leg is asked to touch down, and its unwrapped angle there.

        Args:
            span: Start and end of the time in which touchdowns are listed [s].

        Returns:
            Times [s] and angles, `offset` left out, of each leg [rad].
        """
        found = []
        for down, phase in zip(self.touchdown, self.phase, strict=True):
            first = np.ceil(span[0] / self.period + phase)
            turns = np.arange(first, np.floor(span[1] / self.period + phase) + 1)
            found.append(((turns - phase) * self.period, down + 2 * np.pi * turns))
        return found

    def _since_touchdown(self, t: ArrayLike) -> tuple[Array, Array]:
        """Return the number k of the last touchdown and the time since it [s], (m, n) each.

        Times within 1e-11 of a period of touchdown, lift-off or the end of a pause are moved to it.
        """
        # Times on a kink must not fall before it by rounding: the speed there is that after it.
        cycles = np.atleast_1d(np.asarray(t, dtype=float))[:, None] / self.period + self.phase
        turns = np.floor(cycles + _KINK)
        since = np.maximum(cycles - turns, 0.0) * self.period
        for kink in (self.ground_time, self.ground_time + self.pause):
            since = np.where(np.abs(since - kink) < _KINK * self.period, kink, since)
        return turns, since
