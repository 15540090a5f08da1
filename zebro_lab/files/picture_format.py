# SPDX-License-Identifier: MIT
"""Formats of pictures that commands write: PNG, SVG or PDF; names of the files."""

from pathlib import Path
from typing import Literal, TypeAlias, get_args

from zebro_lab.files.errors import SettingsError

PictureFormat: TypeAlias = Literal["png", "svg", "pdf"]
FORMATS: tuple[PictureFormat, ...] = get_args(PictureFormat)


def in_every_format(*stems: str) -> tuple[str, ...]:
    """Return the file name of each picture in each format, for a result folder's names.

    >>> in_every_format("map")
    ('map.png', 'map.svg', 'map.pdf')
    """
    return tuple(f"{stem}.{form}" for stem in stems for form in FORMATS)


def format_of(path: Path) -> PictureFormat:
    """Return the format that a picture's suffix names, which may be in capitals.

    Raises:
        SettingsError: The suffix names no format of `FORMATS`.
    """
    suffix = path.suffix.lower().removeprefix(".")
    for form in FORMATS:
        if suffix == form:
            return form
    raise SettingsError(
        f"found '{path}'; expected the name of a picture that ends in .{', .'.join(FORMATS)}",
        key="--out",
    )
