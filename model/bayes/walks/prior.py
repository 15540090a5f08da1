# SPDX-License-Identifier: MIT
"""Prior of leg offsets and floor, and the cases of one leg that is mounted wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from model.errors import DomainError
from model.leg_state import LegState
from model.predict import ModelSpread
from model.robot import N_LEGS
from model.slip.law import Array

OFFSETS = tuple(f"leg_offset{leg}" for leg in range(1, N_LEGS + 1))
FLOOR = ("grip", "slip_stiffness", "fall")
# Whether a stepping leg's traction has the post-peak drop of a rig's steady slip (1), or none
# (0), as friction by velocity, has not been measured. Mean and standard deviation of the two,
# equally likely:
FALL, FALL_SD = 0.5, 0.5
# Traction does not rise beyond its peak; a larger drop has not been observed.
FALLS = (0.0, 1.5)
NAMES = (*OFFSETS, *FLOOR, "common_offset", "leg_arc", "steering", "stride")
UNITS = (*["rad"] * N_LEGS, "log", "log", "-", "rad", "rad", "rad/m", "-")
WRONG = len(NAMES)  # index of the wrong leg's further offset, after the others
LINEAR = [NAMES.index("steering"), NAMES.index("stride")]  # residuals are linear in them
WALKED = [i for i in range(WRONG + 1) if i not in LINEAR]  # parameters that need a new walk


@dataclass(frozen=True)
class WrongLeg:
    """A leg with a large constant offset.

    Attributes:
        leg: Its index.
        walk: Index of the only walk in which it is off, as after a knock; None when it is off in
            all of them, as after an assembly.
    """

    leg: int
    walk: int | None = None

    def concerns(self, walk: int | None) -> bool:
        """Return whether the leg is off in a walk; None stands for a walk to come."""
        return self.walk is None or self.walk == walk


Case: TypeAlias = WrongLeg | None
"""A leg that is mounted wrong, or none."""


def wrong_legs(walks: int) -> tuple[WrongLeg, ...]:
    """List the possible cases of one wrong leg: in all walks, or in one of them."""
    legs = range(N_LEGS)
    everywhere = tuple(WrongLeg(leg) for leg in legs)
    if walks < 2:  # with one walk both cases are the same
        return everywhere
    return (*everywhere, *(WrongLeg(leg, walk) for walk in range(walks) for leg in legs))


@dataclass(frozen=True)
class WalkPrior:
    """Prior before any walk.

    Attributes:
        offset_sd: Standard deviation of each leg's own offset [rad].
        common_sd: That of the offset all share: whether counts are rounded or cut is half a count
            [rad].
        arc_sd: That of the legs' arc beyond the described one [rad].
        wrong_sd: That of the further offset of a leg that is mounted wrong [rad].
        wrong: Probability that one leg is mounted wrong [-].
        grip_sd: Standard deviation of the logarithm of the factor on traction: floor and rig differ
            [-].
        stiffness_sd: That of the logarithm of the factor on slip stiffness [-].
        fall_sd: That of the factor on the post-peak drop, about `FALL` [-].
        steering_sd: Standard deviation of the constant curvature that the legs do not explain
            [rad/m].
        stride_sd: That of the relative error of distance [-].
        spread: Errors of the walking model, drawn anew in each walk.

    Raises:
        DomainError: A standard deviation is not positive or `wrong` is not a probability.
    """

    offset_sd: float = float(np.radians(0.2))
    common_sd: float = float(np.radians(1.0))
    arc_sd: float = float(np.radians(3.0))
    wrong_sd: float = float(np.radians(5.0))
    wrong: float = 0.2
    grip_sd: float = 0.3
    stiffness_sd: float = 0.5
    fall_sd: float = FALL_SD
    steering_sd: float = 0.01
    stride_sd: float = 0.005
    spread: ModelSpread = field(default_factory=ModelSpread)

    def __post_init__(self) -> None:
        """Check that standard deviations are positive and that `wrong` is a probability."""
        if not np.all(self.scale > 0):
            raise DomainError("a standard deviation of the prior is not above zero")
        if not 0 < self.wrong < 1:
            raise DomainError(f"a leg is wrong with probability {self.wrong:g}; expected 0 to 1")

    @property
    def scale(self) -> Array:
        """Standard deviations in the order of `NAMES`, and that of a wrong leg, shape (14,)."""
        return np.array([
            *[self.offset_sd] * N_LEGS, self.grip_sd, self.stiffness_sd, self.fall_sd,
            self.common_sd, self.arc_sd, self.steering_sd, self.stride_sd, self.wrong_sd,
        ])  # fmt: skip

    def log_probability(self, case: Case, *, walks: int) -> float:
        """Compute the log prior probability of a case.

        Args:
            case: The leg that is mounted wrong, or None.
            walks: Number of walks.
        """
        if case is None:
            return float(np.log(1 - self.wrong))
        if walks < 2:
            return float(np.log(self.wrong / N_LEGS))
        among = 1 if case.walk is None else walks
        return float(np.log(self.wrong / 2 / N_LEGS / among))

    def sd(self, walks: int) -> Array:
        """Standard deviations in the order of `NAMES` over all cases, shape (13,)."""
        variance = self.scale[:WRONG] ** 2
        variance[:N_LEGS] += (
            np.exp(self.log_probability(WrongLeg(0), walks=walks)) * self.wrong_sd**2
        )
        return np.sqrt(variance)


def all_cases(walks: int) -> tuple[Case, ...]:
    """List every case of a number of walks; no leg wrong comes first."""
    return (None, *wrong_legs(walks))


def legs_of(values: Array, case: Case, *, walk: int | None = None) -> LegState:
    """Convert parameters to the state of the legs in a walk.

    Args:
        values: Parameters in the order of `NAMES` and that of a wrong leg, shape (m, 14).
        case: The leg that is mounted wrong, or None.
        walk: The walk's index; None for a walk to come.
    """
    offset = leg_offsets(values, case, walk=walk)
    grip, stiffness, fall, common, arc, steering, stride = values[:, N_LEGS:WRONG].T
    return LegState(
        offset=offset + common[:, None],
        grip=np.exp(grip),
        stiffness=np.exp(stiffness),
        fall=np.clip(FALL + fall, *FALLS),
        arc=arc,
        steering=steering,
        stride=stride,
    )


def leg_offsets(values: Array, case: Case, *, walk: int | None = None) -> Array:
    """Compute each leg's own offset, without the common one.

    Args:
        values: Parameter values in the order of `NAMES`, then that of a wrong leg, shape (m, 14).
        case: The leg that is mounted wrong, or None.
        walk: Index of the walk; None for a walk to come.

    Returns:
        Offsets, shape (m, 6) [rad].
    """
    offset = values[:, :N_LEGS].copy()
    if case is not None and case.concerns(walk):
        offset[:, case.leg] += values[:, WRONG]
    return offset


def describe(case: Case, walks: Sequence[str]) -> str:
    """Describe a case as text.

    Args:
        case: The case.
        walks: Names of the walks.

    >>> describe(WrongLeg(2), ["a"])
    'leg 3'
    """
    if case is None:
        return "no leg"
    return f"leg {case.leg + 1}" + ("" if case.walk is None else f" in {walks[case.walk]}")
