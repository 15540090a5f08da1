# SPDX-License-Identifier: MIT
"""Pictures of a report, embedded in the page, with captions."""

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_bytes

MOST_PICTURE = 32 << 20
_PNG = b"\x89PNG\r\n\x1a\n"
VALIDATION, ERRORS = "validation", ".errors"
CAPTIONS: Mapping[str, str] = {
    "curves": "Block means of the rig's traction over load, and the fitted slip curve at each load",
    "surface": "Fitted traction over slip ratio and load",
    "corner": "Posterior of the slip law's parameters, each alone and each pair",
    "traces": "The sampler's walkers over its steps",
    "residuals": "Residuals of the fit",
    "walk_parameters": "Prior and posterior of legs and floor",
    "left_out.": "A walk predicted from a fit of the other walks, and its track",
    "overlay": "The tracked path over a photograph",
    "map": "The tracked path over the floor as seen from above, with 90 % regions",
    "path": "Predicted path from above, with the body at several times",
    "band": "Predicted path from above and over time; bands hold 50 and 90 % of the draws",
    "motion": "Predicted position, velocity and acceleration of the body",
    "orientation": "Predicted roll, pitch and yaw with their rates",
    "slip_ratio": "Predicted slip ratio of each leg in the last two cycles",
    "normal_force": "Predicted normal force of each leg in the last two cycles",
    "traction_force": "Predicted traction of each leg in the last two cycles",
    "paired_traction": "Predicted traction of the legs of each pair",
    "gantt": "Predicted stance of each leg in the last two cycles",
    ".floor": "Predicted band and tracked path over the floor as seen from above",
    ".photos": "Photographs from above, and the robot drawn at its predicted pose",
    ".imu": "Roll and pitch, predicted and measured by the IMU",
    ".errors": "Predicted paths and the track, and errors over time",
}
"""Captions by file name without suffix; with a leading dot by the end of that name (validation)."""


@dataclass(frozen=True)
class Picture:
    """A picture embedded in a page.

    Attributes:
        data: Content of the file as a `data:` URL.
        caption: Caption of the picture.
        name: Name of the file.
    """

    data: str
    caption: str
    name: str


def embed(file: Path, *, stage: str, simulated: bool) -> Picture:
    """Encode a picture as a `data:` URL, with its caption.

    Args:
        file: A PNG file.
        stage: Name of the stage that drew the picture.
        simulated: Whether to append "(simulated)" to the caption.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not a PNG, cannot be read, or is larger than `MOST_PICTURE`.
    """
    data = read_bytes(file, most=MOST_PICTURE)
    if not data.startswith(_PNG):
        raise DataError("is not a PNG; delete it and run again what wrote it", file=file)
    encoded = base64.b64encode(data).decode("ascii")
    caption = caption_of(file.stem, stage=stage)
    return Picture(
        f"data:image/png;base64,{encoded}",
        f"{caption} (simulated)" if simulated else caption,
        file.name,
    )


def lies_in(folder: Path, name: str) -> bool:
    """Return whether a file named in a manifest lies directly in the manifest's folder.

    Links are resolved first. A manifest is untrusted input: `../secret.png`, an absolute path or a
    link could refer to any file.

    Args:
        folder: Folder of the manifest.
        name: File name as given in the manifest.
    """
    if Path(name).name != name or "\0" in name:
        return False
    return (folder / name).resolve().parent == folder.resolve()


def place_of(name: str) -> tuple[int, str]:
    """Return the sort key of a picture's file name: index in `CAPTIONS` (else last), then name.

    A key with a leading dot fits if it is in the name, one with a final dot if the name begins with
    it, another if it is the name without `.png`.

    >>> sorted(["corner.png", "curves.png", "b.imu.png", "b.png"], key=place_of)
    ['curves.png', 'corner.png', 'b.imu.png', 'b.png']
    """
    stem = name.removesuffix(".png")
    keys = list(CAPTIONS)
    mine = (i for i, key in enumerate(keys) if _names(key, stem) or (key[0] == "." and key in stem))
    return next(mine, len(keys)), name


def _names(key: str, stem: str) -> bool:
    """Return whether a key of `CAPTIONS` is a picture's name, or with a final dot its beginning."""
    return stem == key or (key[-1] == "." and stem.startswith(key))


def caption_of(stem: str, *, stage: str) -> str:
    """Return the caption of a picture, from its file name and the stage that drew it.

    In a validation it is that of the key with a leading dot that ends the name, by default
    `.errors`; else that of the name in `CAPTIONS`, by default the name with spaces.

    Args:
        stem: File name of the picture without suffix.
        stage: Name of the stage that drew the picture.

    >>> caption_of("walk-3.photos", stage="validation")
    'Photographs from above, and the robot drawn at its predicted pose'
    >>> caption_of("left_out.walk1", stage="walks")
    'A walk predicted from a fit of the other walks, and its track'
    >>> caption_of("my-walk", stage="validation")
    'Predicted paths and the track, and errors over time'
    """
    if stage == VALIDATION:
        end = next((end for end in CAPTIONS if end[0] == "." and stem.endswith(end)), ERRORS)
        return CAPTIONS[end]
    words = stem.replace("_", " ").replace("-", " ")
    return next((CAPTIONS[key] for key in CAPTIONS if _names(key, stem)), words)
