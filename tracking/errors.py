# SPDX-License-Identifier: MIT
"""What can be wrong with photographs, and with what is asked of them."""


class TrackingError(Exception):
    """Root of every error that `tracking` raises on purpose; its message is one line."""

    def __str__(self) -> str:
        """Return the message on one line, whatever names of files and cells it quotes."""
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
    """The boards seen do not determine the lens."""


class FloorError(TrackingError, ValueError):
    """The floor's marks do not place the camera."""


class MarkerError(TrackingError, ValueError):
    """A marker or a dictionary of markers is not what was asked for."""


class BodyError(TrackingError, ValueError):
    """The robot's own picture does not serve as its template."""


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
    """A correction names what does not exist or says what cannot be."""


class CompositeError(TrackingError, ValueError):
    """A composite photograph does not show exposures that can be told apart."""


class PathError(TrackingError, ValueError):
    """The poses do not make a path."""
