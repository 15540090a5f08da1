# SPDX-License-Identifier: MIT
"""Commands to the robot: leg set-points of a gait, and stop."""

from contextlib import suppress
from typing import Final, Protocol

from model.gait.reference import LegReference
from rig.errors import LimitExceeded, RigError
from rig.zebro.profile import LegProfile, encode_counts

LONGEST_MOTION: Final = 65.535
"""Longest duration of a motion that 16 bits of milliseconds can encode [s]."""
MILLISECOND: Final = 1e-3
"""One millisecond [s]."""


class LegCommands(Protocol):
    """Commands to the robot's legs: motion to counts, and stop."""

    @property
    def profile(self) -> LegProfile:
        """Profile of the robot."""
        ...

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count, the short way round.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.

        Raises:
            LimitExceeded: The duration is negative or above `LONGEST_MOTION`.
            ProtocolError: This robot takes no commands.
            RigTimeout: The link is connected but does not take the command.
        """
        ...

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""
        ...


def leave_still(legs: LegCommands) -> None:
    """Stop legs that were moved, before their driver is left; a link that fails is left as it is.

    Args:
        legs: Robot whose legs were commanded.
    """
    with suppress(RigError):
        legs.stop()


def milliseconds(duration: float) -> int:
    """Convert the duration of a motion to whole milliseconds, which the protocols send.

    Args:
        duration: Duration of a motion [s].

    Returns:
        The duration, rounded [ms].

    Raises:
        LimitExceeded: The duration is negative or above `LONGEST_MOTION`.
    """
    if not 0 <= duration <= LONGEST_MOTION:
        raise LimitExceeded("duration (>= 0) of a leg motion", value=duration, limit=LONGEST_MOTION,
                            unit="s")  # fmt: skip
    return round(duration / MILLISECOND)


def follow(
    legs: LegCommands, reference: LegReference, *, start: float, now: float, horizon: float
) -> bool:
    """Send the leg angles that a gait has a time `horizon` ahead as set-points.

    Called repeatedly, at intervals of at most `horizon`, it makes the robot walk. A leg must move
    less than half a turn within the horizon, or it would turn in the wrong direction.

    Args:
        legs: Robot whose legs are commanded.
        reference: Gait with the leg angles over time since its beginning.
        start: Host time at which the gait began [s].
        now: Host time [s].
        horizon: Time ahead at which the set-point is due, and duration of the motion to it [s].

    Returns:
        Whether the link took the command.

    Raises:
        LimitExceeded, ProtocolError: As `LegCommands.set_points`.
    """
    theta = reference.angles(now - start + horizon)[0]
    chosen = [theta[leg - 1] for leg in sorted(legs.profile.legs)]
    return legs.set_points(encode_counts(legs.profile, chosen), horizon)
