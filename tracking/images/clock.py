# SPDX-License-Identifier: MIT
"""Clock offset between camera and computer, from one photograph of a QR code with the time."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.errors import PhotoError
from tracking.images.read import read_pixels
from tracking.images.times import exif_time

_PREFIX = "zebro-clock:"


@dataclass(frozen=True)
class CameraClockOffset:
    """Offset of the camera's clock from the computer's clock.

    Attributes:
        seconds: Camera's time, its EXIF stamp taken as UTC, minus computer's time in UTC; positive
            when the camera is ahead [s].
        sd: Standard deviation of `seconds`, from the step of the EXIF time and the renewal
            interval of the QR code [s].
    """

    seconds: float
    sd: float


def clock_text(t: float) -> str:
    """Format a time as the text of the QR clock, with milliseconds.

    Args:
        t: Seconds since 1970, UTC [s].

    >>> clock_text(1.5)
    'zebro-clock:1.500'
    """
    return f"{_PREFIX}{t:.3f}"


def clock_picture(t: float, *, module_px: int = 12) -> NDArray[np.uint8]:
    """Draw the QR code of `clock_text(t)` with a white margin of at least four squares.

    Args:
        t: Seconds since 1970, UTC [s].
        module_px: Side of one square of the code [px].

    Returns:
        Grey picture, shape (n, n).
    """
    code = np.asarray(cv2.QRCodeEncoder.create().encode(clock_text(t)), dtype=np.uint8)
    n = module_px * code.shape[0]
    large = np.asarray(cv2.resize(code, (n, n), interpolation=cv2.INTER_NEAREST), dtype=np.uint8)
    return np.pad(large, 4 * module_px, constant_values=255)


def read_clock(pixels: NDArray[np.uint8]) -> float | None:
    """Decode the time in a photographed QR clock.

    Args:
        pixels: The photograph, grey or BGR.

    Returns:
        Seconds since 1970, UTC [s]; None where no QR code is decoded or its text is not a time.
    """
    text, _, _ = cv2.QRCodeDetector().detectAndDecode(pixels)
    if not text.startswith(_PREFIX):
        return None
    try:
        return float(text.removeprefix(_PREFIX))
    except ValueError:
        return None


def clock_offset(path: Path, *, renewal: float = 0.1) -> CameraClockOffset:
    """Compute the camera's clock offset from a photograph of the QR clock and its EXIF time.

    Half a step is added to the EXIF time and half of `renewal` to the time shown.

    Args:
        path: Photograph of the QR clock.
        renewal: Interval at which the code on the screen is renewed [s].

    Raises:
        PhotoError: When the photograph cannot be read, shows no QR clock or has no EXIF time.
        OSError: When the folder of the file may not be searched.
    """
    shown = read_clock(read_pixels(path))
    if shown is None:
        raise PhotoError(
            path.name, "no QR clock is decoded; fill a third of the picture with it, without glare"
        )
    stamp = exif_time(path)
    if stamp is None:
        raise PhotoError(path.name, "the file has no EXIF time; give the camera's own file")
    taken, step = stamp
    sd = float(np.sqrt((step**2 + renewal**2) / 12))
    return CameraClockOffset(taken + step / 2 - (shown + renewal / 2), sd)
