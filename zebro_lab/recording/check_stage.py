# SPDX-License-Identifier: MIT
"""Determine leg order, signs and zeros of a robot with a person's observations; write a profile."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.openers import LEGS_PROFILE, SIMULATED, legs_at, resolve
from rig.zebro.check import LiftOff, check_legs, find_lift_off, latest_counts, zero_legs
from rig.zebro.profile import LegProfile, encode_counts, save_leg_profile
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.recording.devices import default_gait
from zebro_lab.recording.request import CheckRequest

MOVING: Final = 1.0
"""Duration of a leg's turn to an angle, and wait before the height is asked for [s]."""


class Person(Protocol):
    """Interface to a person who watches the robot and reports observations."""

    def watch(self, channel: int) -> tuple[int, bool]:
        """Return which leg moved with a channel (from 0), and whether it turned forward."""
        ...

    def hold_toes_ahead(self) -> None:
        """Return once a person holds every toe straight ahead."""
        ...

    def measure_height(self, theta_deg: float) -> float:
        """Return the height of a hip above the ground [m] whose leg stands at an angle [deg]."""
        ...


@dataclass(frozen=True)
class Checked:
    """Result of a check of the robot's legs.

    Attributes:
        file: File of the written profile.
        profile: Content of the written profile.
        source: Source of the leg angles, "real" or "sim:WHAT".
        lift_off: Lift-off angle; None where no touchdown angle was given.
    """

    file: Path
    profile: LegProfile
    source: str
    lift_off: LiftOff | None = None


def check_zebro(request: CheckRequest, person: Person, *, clock: Clock = SYSTEM_CLOCK) -> Checked:
    """Find order, signs and zeros of a robot's legs, moving each leg, and write its profile.

    The profile is written before the lift-off angle is sought, if that is asked for.

    Args:
        request: Address of the robot, file to write, touchdown angle.
        person: Observer of the robot: which leg moved, its direction, heights.
        clock: Clock of host time.

    Returns:
        The profile, and the lift-off angle where a touchdown angle is given.

    Raises:
        AlreadyExists: The file to write exists; the robot was not moved.
        RigError: The address is invalid, the robot cannot be reached, sends no samples or does not
            follow, or one leg was reported for two channels.
        OSError: The profile cannot be written.
    """
    if request.save.exists():
        raise AlreadyExists(f"{request.save} exists already; choose another file with --save")
    with _robot(request.address) as robot:
        # The driver's profile does not change: both steps refer to channels of the wire.
        ordered = check_legs(robot, person.watch, clock=clock)
        person.hold_toes_ahead()
        zeros = zero_legs(robot, clock=clock).zero_counts
        profile = replace(ordered, zero_counts=zeros, name=request.save.stem)
        save_leg_profile(profile, request.save)
        found = None
        if request.touchdown_deg is not None:
            found = _lift_off(robot, profile, request.touchdown_deg, person, clock)
    return Checked(request.save, profile, robot.source, found)


@contextmanager
def _robot(address: str) -> Iterator[Any]:
    """Open the robot; a simulated one, which walks from its start, is stopped where it is."""
    _, port = resolve(address, default=LEGS_PROFILE)
    with legs_at(address, default_gait(), rng=np.random.default_rng(0)) as robot, robot:
        if port == SIMULATED:
            robot.set_points(latest_counts_as_targets(robot), 0.0)
        yield robot


def latest_counts_as_targets(robot: Any) -> tuple[int, ...]:
    """Return the present count of each leg within one turn; as set-points they stop a gait.

    Raises:
        RigTimeout: The robot sends no sample.
    """
    around = robot.profile.counts_per_revolution
    return tuple(int(count) % around for count in latest_counts(robot))


def _lift_off(
    robot: Any, profile: LegProfile, touchdown_deg: float, person: Person, clock: Clock
) -> LiftOff:
    """Find the lift-off angle: turn all legs to each angle tried, and ask for the hip's height."""

    def height(theta: float) -> float:
        """Turn all legs to an angle [rad] within `MOVING`; return the hip's height by a person [m].

        Samples are read meanwhile, so that they do not pile up in the driver.
        """
        robot.set_points(encode_counts(profile, [theta] * len(profile.legs)), MOVING)
        end = clock.now() + MOVING
        while clock.now() < end:
            robot.read(min(0.05, max(end - clock.now(), 0.0)))
        return person.measure_height(math.degrees(theta))

    return find_lift_off(
        height,
        math.radians(touchdown_deg),
        counts_per_revolution=profile.counts_per_revolution,
    )
