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
SETTLING: Final = 0.5
ANSWER_TIMEOUT: Final = 2.0


class CheckedLegs(LegCommands, Stream, Protocol):
    """A robot that can be read and commanded."""


@dataclass(frozen=True)
class MovedLeg:
    """Observation of the leg that moved when the count of one channel was increased.

    Attributes:
        leg: Number of the leg that moved.
        forward: Whether it turned as in walking forward.
    """

    leg: int
    forward: bool


def check_legs(
    robot: CheckedLegs,
    observe: Callable[[int], MovedLeg],
    *,
    clock: Clock = SYSTEM_CLOCK,
) -> LegProfile:
    """Determine leg order and signs: move each channel up in turn and ask which leg moved.

    Args:
        robot: The robot, open, its legs free.
        observe: Asks the person what was seen; gets the channel, from 0.
        clock: Host time.

    Returns:
        The profile with `legs` and `sign` as observed; zeros are kept with their channels.

    Raises:
        RigTimeout: The robot sends nothing.
        DeviceFault: A channel did not follow its command, or a leg was seen twice.
    """
    seen: list[MovedLeg] = []
    for channel in range(len(robot.profile.legs)):
        move_channel(robot, channel, clock=clock)
        observation = observe(channel)
        if observation.leg in [earlier.leg for earlier in seen]:
            raise DeviceFault(
                f"leg {observation.leg} was seen to move for two channels, the second "
                f"{channel + 1}; start again",
                status=channel,
            )
        seen.append(observation)
    return replace(
        robot.profile,
        legs=tuple(observation.leg for observation in seen),
        sign=tuple(1 if observation.forward else -1 for observation in seen),
    )


def move_channel(robot: CheckedLegs, channel: int, *, clock: Clock = SYSTEM_CLOCK) -> None:
    """Move one channel up by `STEP` and hold all others; check that it followed.

    Args:
        robot: The robot, open.
        channel: Channel, from 0.
        clock: Host time.

    Raises:
        RigTimeout: The robot sends nothing.
        DeviceFault: The channel stayed, or another one moved.
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
                f"channel {channel + 1} was commanded to move by {step} counts; channel "
                f"{other + 1} moved by {moved:g} where {wanted} was expected",
                status=other,
            )


def zero_legs(robot: CheckedLegs, *, clock: Clock = SYSTEM_CLOCK) -> LegProfile:
    """Determine zeros: the present counts, while a person holds every toe straight ahead.

    Args:
        robot: The robot, open.
        clock: Host time.

    Returns:
        The profile with `zero_counts` as read.

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
        Counts in the order of the wire.

    Raises:
        RigTimeout: The robot sends nothing.
    """
    robot.read(0.0)
    end = clock.now() + ANSWER_TIMEOUT
    while (left := end - clock.now()) > 0:
        samples = robot.read(left)
        if samples:
            return samples[-1].counts
    raise RigTimeout(f"stream '{robot.name}' sent nothing", waited=ANSWER_TIMEOUT)


@dataclass(frozen=True)
class LiftOff:
    """A lift-off angle found on the robot.

    Attributes:
        theta: The angle, a whole number of counts [rad].
        mismatch: Hip height there less that at touchdown [m].
        measurements: Number of measured heights.
    """

    theta: float
    mismatch: float
    measurements: int


def find_lift_off(
    hip_height: Callable[[float], float], touchdown: float, *, counts_per_revolution: int
) -> LiftOff:
    r"""Find the lift-off angle whose hip height is the touchdown's, sections 2-6-1 and 5-2-3.

    Past the vertical a leg's hip only sinks, so that the angle is found by halving, among the
    angles that the robot can count. A half-circular leg would have it at
    :math:`2\sin\theta_{LO} = 1 + \sin\theta_{TD}`, Eq. (2-17); real ones are longer than that,
    and the thesis measured 130° where that equation gives 118°.

    Args:
        hip_height: Turns a standing leg to an angle [rad] and measures the height of its hip [m].
        touchdown: Touchdown angle, below pi/2 [rad].
        counts_per_revolution: Counts of a whole turn.

    Returns:
        The count angle with the nearest height.
    """
    count = 2 * math.pi / counts_per_revolution
    heights: dict[int, float] = {}

    def above(index: int) -> float:
        if index not in heights:
            heights[index] = hip_height(index * count)
        return heights[index] - wanted

    wanted = hip_height(touchdown)
    low, high = math.ceil(np.pi / 2 / count), math.floor(np.pi / count)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if above(middle) > 0 else (low, middle)
    best = min((low, high), key=lambda index: abs(above(index)))
    return LiftOff(best * count, above(best), len(heights) + 1)
