# SPDX-License-Identifier: MIT
"""Prior of leg offsets and floor, and the cases of one wrongly mounted leg."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.leg_state import ANISOTROPY, LegState, log_spread
from model.predict import ModelSpread
from model.robot import N_LEGS

OFFSETS = tuple(f"leg_offset{leg}" for leg in range(1, N_LEGS + 1))
LATERAL = ("lateral_grip", "lateral_stiffness")  # across the legs over along them
FLOOR = ("grip", "slip_stiffness", "fall", *LATERAL)
# Whether a stepping leg's traction has the post-peak drop of a rig's steady slip (1), or none
# (0), as friction by velocity, has not been measured. Mean and standard deviation of the two,
# equally likely:
FALL, FALL_SD = 0.5, 0.5
# Traction does not rise beyond its peak; a larger drop has not been observed.
FALLS = (0.0, 1.5)
NAMES = (*OFFSETS, *FLOOR, "common_offset", "leg_arc", "steering", "stride")
UNITS = (*["rad"] * N_LEGS, "log", "log", "-", "log", "log", "rad", "rad", "rad/m", "-")
WRONG = len(NAMES)  # index of a wrongly mounted leg's further offset, after `NAMES`
ACROSS = [NAMES.index(name) for name in LATERAL]
LINEAR = [NAMES.index("steering"), NAMES.index("stride")]  # residuals are linear in them
WALKED = [i for i in range(WRONG + 1) if i not in LINEAR]  # parameters that need a new walk


@dataclass(frozen=True)
class WrongLeg:
    """A wrongly mounted leg: one with a large constant offset.

    Attributes:
        leg: Index of the leg, from 0.
        walk: Index of the only walk in which the leg has the offset, as after a knock; None when it
            has the offset in all walks, as after an assembly.
    """

    leg: int
    walk: int | None = None

    def concerns(self, walk: int | None) -> bool:
        """Return whether the leg has the offset in walk number `walk`.

        None is a walk to come, in which only a leg wrongly mounted in all walks has it.
        """
        return self.walk is None or self.walk == walk


Case: TypeAlias = WrongLeg | None
"""A wrongly mounted leg, or None for none."""


def wrong_legs(walks: int) -> tuple[WrongLeg, ...]:
    """List the cases of one wrongly mounted leg: six in all walks, then six in each single walk.

    Args:
        walks: Number of walks; of fewer than two only the first six cases are listed.
    """
    legs = range(N_LEGS)
    everywhere = tuple(WrongLeg(leg) for leg in legs)
    if walks < 2:  # with one walk both cases are the same
        return everywhere
    return (*everywhere, *(WrongLeg(leg, walk) for walk in range(walks) for leg in legs))


@dataclass(frozen=True)
class WalkPrior:
    """Gaussian prior of leg offsets and floor before any tracked walk; sd: standard deviation.

    Attributes:
        offset_sd: Sd of each leg's own offset, about zero [rad].
        common_sd: Sd of the offset that all legs share: rounded and truncated encoder counts
            differ by half a count [rad].
        arc_sd: Sd of the angle of the legs' arc, about the described angle [rad].
        wrong_sd: Sd of the further offset of a wrongly mounted leg [rad].
        wrong: Probability that one leg is wrongly mounted [-].
        grip_sd: Sd of the natural logarithm of the factor on traction: floor and rig differ [-].
        stiffness_sd: Sd of the natural logarithm of the factor on slip stiffness [-].
        fall_sd: Sd of the factor on the post-peak drop, about `FALL` [-].
        lateral_sd: Sd of the natural logarithms of lateral over longitudinal grip and of lateral
            over longitudinal slip stiffness; 0 to hold both at 1 [-].
        steering_sd: Sd of the constant curvature that the legs do not explain [rad/m].
        stride_sd: Sd of the relative error of distance [-].
        spread: Standard deviations of the walking model's errors, drawn anew in each walk.

    Raises:
        DomainError: A standard deviation is not positive, that of lateral traction negative, or
            `wrong` is not between 0 and 1, both excluded.
    """

    offset_sd: float = float(np.radians(0.2))
    common_sd: float = float(np.radians(1.0))
    arc_sd: float = float(np.radians(3.0))
    wrong_sd: float = float(np.radians(5.0))
    wrong: float = 0.2
    grip_sd: float = 0.3
    stiffness_sd: float = 0.5
    fall_sd: float = FALL_SD
    lateral_sd: float = log_spread(ANISOTROPY)
    steering_sd: float = 0.01
    stride_sd: float = 0.005
    spread: ModelSpread = field(default_factory=ModelSpread)

    def __post_init__(self) -> None:
        """Check that `wrong` is above 0 and below 1, and standard deviations are positive.

        That of lateral traction may be 0.
        """
        names = (*NAMES, "wrong_leg")
        bad = [
            f"{name} {sd:g}"
            for name, sd in zip(names, self.scale, strict=True)
            if not (sd > 0 or (sd == 0 and name in LATERAL))
        ]
        if bad:
            raise DomainError(
                f"standard deviations of the prior: found {', '.join(bad)}; expected above 0"
            )
        if not 0 < self.wrong < 1:
            raise DomainError(
                f"found {self.wrong:g} as the probability of a wrongly mounted leg; expected a "
                "number above 0 and below 1"
            )

    @property
    def scale(self) -> Array:
        """Standard deviations in the order of `NAMES`, then `wrong_sd`, shape (16,)."""
        return np.array([
            *[self.offset_sd] * N_LEGS, self.grip_sd, self.stiffness_sd, self.fall_sd,
            self.lateral_sd, self.lateral_sd, self.common_sd, self.arc_sd, self.steering_sd,
            self.stride_sd, self.wrong_sd,
        ])  # fmt: skip

    def log_probability(self, case: Case, *, walks: int) -> float:
        """Compute the natural logarithm of the prior probability of a case.

        Of two or more walks half of `wrong` is for a leg wrongly mounted in all walks, and half for
        one in a single walk; all legs and walks are equally likely.

        Args:
            case: The wrongly mounted leg, or None.
            walks: Number of walks.
        """
        if case is None:
            return float(np.log(1 - self.wrong))
        if walks < 2:
            return float(np.log(self.wrong / N_LEGS))
        among = 1 if case.walk is None else walks
        return float(np.log(self.wrong / 2 / N_LEGS / among))

    def sd(self, walks: int) -> Array:
        """Compute standard deviations over all cases in the order of `NAMES`, shape (15,).

        A leg's offset includes the further offset of a leg wrongly mounted in all walks, by its
        probability.

        Args:
            walks: Number of walks.
        """
        variance = self.scale[:WRONG] ** 2
        variance[:N_LEGS] += (
            np.exp(self.log_probability(WrongLeg(0), walks=walks)) * self.wrong_sd**2
        )
        return np.sqrt(variance)


def all_cases(walks: int) -> tuple[Case, ...]:
    """List every case of a number of walks: None (no wrongly mounted leg), then `wrong_legs`."""
    return (None, *wrong_legs(walks))


def legs_of(values: Array, case: Case, *, walk: int | None = None) -> LegState:
    """Convert parameter vectors to m draws of the legs' state in a walk.

    Args:
        values: Parameters in the order of `NAMES`, then the further offset of a wrongly mounted
            leg, shape (m, 16); factors as logarithms, but the post-peak drop's about `FALL`.
        case: The wrongly mounted leg, or None.
        walk: Index of the walk; None for a walk to come, in which only a leg wrongly mounted in all
            walks has its further offset.

    Returns:
        The state; offsets include the common one, the post-peak drop is held within `FALLS`.
    """
    offset = leg_offsets(values, case, walk=walk)
    grip, stiffness, fall, across, across_stiffness, *others = values[:, N_LEGS:WRONG].T
    common, arc, steering, stride = others
    return LegState(
        offset=offset + common[:, None],
        grip=np.exp(grip),
        stiffness=np.exp(stiffness),
        fall=np.clip(FALL + fall, *FALLS),
        lateral_grip=np.exp(across),
        lateral_stiffness=np.exp(across_stiffness),
        arc=arc,
        steering=steering,
        stride=stride,
    )


def leg_offsets(values: Array, case: Case, *, walk: int | None = None) -> Array:
    """Compute each leg's own offset, a wrongly mounted leg's further offset included.

    The offset that all legs share is not included.

    Args:
        values: Parameters in the order of `NAMES`, then the further offset, shape (m, 16).
        case: The wrongly mounted leg, or None.
        walk: Index of the walk; None for a walk to come, in which only a leg wrongly mounted in all
            walks has its further offset.

    Returns:
        Offsets, shape (m, 6) [rad].
    """
    offset = values[:, :N_LEGS].copy()
    if case is not None and case.concerns(walk):
        offset[:, case.leg] += values[:, WRONG]
    return offset


def describe(case: Case, walks: Sequence[str]) -> str:
    """Format a case as text: number of the wrongly mounted leg, and the walk if in one only.

    Args:
        case: The wrongly mounted leg; None is formatted as "no leg".
        walks: Names of the walks, by index.

    >>> describe(WrongLeg(2), ["a"])
    'leg 3'
    """
    if case is None:
        return "no leg"
    return f"leg {case.leg + 1}" + ("" if case.walk is None else f" in {walks[case.walk]}")
