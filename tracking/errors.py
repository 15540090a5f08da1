# SPDX-License-Identifier: MIT
"""Exceptions of `tracking`."""


class TrackingError(Exception):
    """Base class of the exceptions that `tracking` raises; the message is one line."""

    def __str__(self) -> str:
        """Return the message on one line, also where it quotes names with line breaks."""
        return " ".join(super().__str__().split())


class PhotoError(TrackingError, ValueError):
    """One photograph cannot be used; other photographs are not affected.

    Attributes:
        photo: Name of the photograph.
        reason: What was found, what was expected, what to try.
    """

    def __init__(self, photo: str, reason: str) -> None:
        super().__init__(f"{photo}: {reason}")
        self.photo = photo
        self.reason = reason


class NoUsablePhoto(TrackingError, ValueError):
    """No photograph can be used or shows the robot, or the template's photograph cannot be used."""


class TrackStopped(TrackingError):
    """Tracking was stopped on request; nothing was written."""


class CalibrationError(TrackingError, ValueError):
    """The pictures of a board cannot be read or do not determine the camera's parameters."""


class FloorError(TrackingError, ValueError):
    """The floor map is invalid or does not fit, or too few of its marks are seen for a pose."""


class MarkerError(TrackingError, ValueError):
    """A marker or a dictionary of markers is unknown or invalid, or shared by robot and floor."""


class BodyError(TrackingError, ValueError):
    """The robot's top is not annotated, has invalid sides, or cannot be used as a template."""


class AmbiguousHeading(BodyError):
    """The robot's head and tail cannot be distinguished over a sequence of photographs.

    Attributes:
        odds: Odds of the likeliest sequence of headings to the likeliest one with head and tail
            exchanged in every photograph [-].
    """

    def __init__(self, message: str, odds: float) -> None:
        super().__init__(message)
        self.odds = odds


class TimesError(TrackingError, ValueError):
    """Times of photographs are missing or invalid, or lie outside the run they should belong to."""


class CorrectionError(TrackingError, ValueError):
    """A correction is invalid, or names a photograph for which no pose was found."""


class CompositeError(TrackingError, ValueError):
    """The exposures of a composite photograph cannot be found.

    Or the known one is cut, too small or too faint to find others, or the robot's size is unknown.
    """


class PathError(TrackingError, ValueError):
    """There are no poses to smooth, or their times do not increase, or array shapes disagree."""
