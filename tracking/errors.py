# SPDX-License-Identifier: MIT
"""Exceptions of `tracking`."""


class TrackingError(Exception):
    """Base class of the exceptions that `tracking` raises; the message is one line."""

    def __str__(self) -> str:
        """Return the message on one line, also where it quotes names with line breaks."""
        return " ".join(super().__str__().split())


class PhotoError(TrackingError, ValueError):
    """One photograph cannot be used; the others can.

    Attributes:
        photo: Name of the photograph.
        reason: What was found, what was expected, what to try.
    """

    def __init__(self, photo: str, reason: str) -> None:
        super().__init__(f"{photo}: {reason}")
        self.photo = photo
        self.reason = reason


class NoUsablePhoto(TrackingError, ValueError):
    """No photograph can be used, or none shows the robot."""


class TrackStopped(TrackingError):
    """Tracking was stopped on request; nothing was written."""


class CalibrationError(TrackingError, ValueError):
    """The calibration boards found do not determine the lens."""


class FloorError(TrackingError, ValueError):
    """The camera's pose cannot be computed from the floor's marks."""


class MarkerError(TrackingError, ValueError):
    """A marker or a dictionary of markers is unknown or invalid."""


class BodyError(TrackingError, ValueError):
    """The robot's top cannot be used as a template."""


class AmbiguousHeading(BodyError):
    """Head and tail of the robot cannot be told apart in any photograph.

    Attributes:
        odds: Odds of the better to the worse reading of the whole sequence [-].
    """

    def __init__(self, message: str, odds: float) -> None:
        super().__init__(message)
        self.odds = odds


class TimesError(TrackingError, ValueError):
    """The photographs' times are missing or contradict each other."""


class CorrectionError(TrackingError, ValueError):
    """A correction names an unknown photograph or is invalid."""


class CompositeError(TrackingError, ValueError):
    """The exposures of a composite photograph cannot be found or separated."""


class PathError(TrackingError, ValueError):
    """The poses do not make a path."""
