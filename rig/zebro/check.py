# SPDX-License-Identifier: MIT
"""Find a robot's leg order, signs and zeros by moving one leg at a time; and its lift-off angle.

The robot stands on a block with its legs free. A person observes which leg moves and in which
direction, because the stream does not contain this.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Stream
from rig.errors import DeviceFault, RigTimeout
from rig.zebro.commands import LegCommands
from rig.zebro.profile import LegProfile

STEP: Final = 0.1
"""Motion of a leg that a person observes [turns]."""
DURATION: Final = 0.5
"""Duration of that motion [s]."""
SETTLING: Final = 0.5
"""Wait after that motion before the counts are compared [s]."""
ANSWER_TIMEOUT: Final = 2.0
"""Longest wait for a sample of the robot [s]."""


class CheckedLegs(LegCommands, Stream, Protocol):
    """A robot whose leg stream can be read and that takes leg commands."""


def check_legs(
    robot: CheckedLegs,
    observe: Callable[[int], tuple[int, bool]],
    *,
    clock: Clock = SYSTEM_CLOCK,
) -> LegProfile:
    """Determine leg order and signs: move each channel up in turn and ask which leg moved.

    Args:
        robot: The robot, open, its legs free.
        observe: Called after each motion with the channel, from 0; asks a person which leg moved,
            1 to 6, and whether it turned as in walking forward.
        clock: Host time.

    Returns:
        The robot's profile with `legs` and `sign` as observed; each channel keeps its zero.

    Raises:
        RigTimeout: The robot sends nothing, or its link takes no bytes.
        DeviceFault: A channel did not follow its command, another channel moved, or the same leg
            was observed for two channels.
        ProtocolError: The robot takes no commands.
    """
    seen: dict[int, bool] = {}
    for channel in range(len(robot.profile.legs)):
        move_channel(robot, channel, clock=clock)
        leg, forward = observe(channel)
        if leg in seen:
            raise DeviceFault(
                f"leg {leg} was seen to move for two channels, the second of them "
                f"channel {channel + 1}; start again and watch which leg moves",
                status=channel,
            )
        seen[leg] = forward
    return replace(
        robot.profile,
        legs=tuple(seen),
        sign=tuple(1 if forward else -1 for forward in seen.values()),
    )


def move_channel(robot: CheckedLegs, channel: int, *, clock: Clock = SYSTEM_CLOCK) -> None:
    """Raise one channel's count by `STEP` (at least 1 count), hold the others, and check all.

    Args:
        robot: The robot, open.
        channel: Channel, from 0.
        clock: Host time.

    Raises:
        RigTimeout: The robot sends nothing, or its link takes no bytes.
        DeviceFault: A channel's motion is more than a quarter of the step, and more than 1 count,
            from the commanded one.
        ProtocolError: The robot takes no commands.
    """
    around = robot.profile.counts_per_revolution
    before = latest_counts(robot, clock=clock)
    step = max(round(STEP * around), 1)
    targets = [int(count) % around for count in before]
    targets[channel] = (targets[channel] + step) % around
    robot.set_points(tuple(targets), DURATION)
    end = clock.now() + DURATION + SETTLING
    while (left := end - clock.now()) > 0:
        robot.read(min(0.05, left))
    after = latest_counts(robot, clock=clock)
    for other, (was, now) in enumerate(zip(before, after, strict=True)):
        moved = (now - was + around / 2) % around - around / 2
        wanted = step if other == channel else 0
        if abs(moved - wanted) > max(step / 4, 1):
            raise DeviceFault(
                f"channel {channel + 1} was to move by {step} counts; channel {other + 1} "
                f"moved by {moved:g}, expected {wanted} +/- {max(step / 4, 1):g}; free the legs",
                status=other,
            )


def zero_legs(robot: CheckedLegs, *, clock: Clock = SYSTEM_CLOCK) -> LegProfile:
    """Measure the zeros: each channel's count while a person holds every toe straight ahead.

    Args:
        robot: The robot, open.
        clock: Host time.

    Returns:
        The robot's profile with `zero_counts` as read, below a revolution.

    Raises:
        RigTimeout: The robot sends nothing.
    """
    around = robot.profile.counts_per_revolution
    counts = latest_counts(robot, clock=clock)
    return replace(robot.profile, zero_counts=tuple(count % around for count in counts))


def latest_counts(robot: CheckedLegs, *, clock: Clock = SYSTEM_CLOCK) -> tuple[float, ...]:
    """Discard buffered samples, wait for a new one, and return the last counts.

    Args:
        robot: The robot, open.
        clock: Host time.

    Returns:
        Counts by channel, in the order of the wire.

    Raises:
        RigTimeout: No new sample arrived within `ANSWER_TIMEOUT`.
    """
    robot.read(0.0)
    end = clock.now() + ANSWER_TIMEOUT
    while (left := end - clock.now()) > 0:
        samples = robot.read(left)
        if samples:
            return samples[-1].counts
    raise RigTimeout(f"stream '{robot.name}' sent nothing", waited=ANSWER_TIMEOUT,
                     advice="check power and cable of the robot")  # fmt: skip


@dataclass(frozen=True)
class LiftOff:
    """A lift-off angle found on the robot.

    Attributes:
        theta: Lift-off angle, a whole number of counts [rad].
        mismatch: Hip height at `theta` less hip height at touchdown [m].
    """

    theta: float
    mismatch: float


def find_lift_off(
    hip_height: Callable[[float], float], touchdown: float, *, counts_per_revolution: int
) -> LiftOff:
    r"""Find the lift-off angle with the hip height of touchdown, sections 2-6-1 and 5-2-3.

    Past the vertical a leg's hip only sinks, so that the angle is found by bisection, among the
    angles between pi/2 and pi that are whole counts. For a half-circular leg
    :math:`2\sin\theta_{LO} = 1 + \sin\theta_{TD}`, Eq. (2-17); arcs of real legs are longer, and
    the Thesis measured 130° where that equation gives 118°.

    Args:
        hip_height: Turns a standing leg to an angle [rad] and measures the height of its hip [m].
        touchdown: Touchdown angle, below pi/2 [rad].
        counts_per_revolution: Counts of a whole turn.

    Returns:
        Of the two angles that the bisection leaves, the one whose hip height is nearest to that at
        touchdown.
    """
    count = 2 * math.pi / counts_per_revolution
    heights: dict[int, float] = {}

    def above(index: int) -> float:
        """Return the hip height at `index` counts less that at touchdown; measure it only once."""
        if index not in heights:
            heights[index] = hip_height(index * count)
        return heights[index] - wanted

    wanted = hip_height(touchdown)
    low, high = math.ceil(np.pi / 2 / count), math.floor(np.pi / count)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if above(middle) > 0 else (low, middle)
    best = min((low, high), key=lambda index: abs(above(index)))
    return LiftOff(best * count, above(best))
