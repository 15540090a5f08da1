# SPDX-License-Identifier: MIT
"""Options of pictures that several commands share: format, width, snapshots, window of time."""

from typing import Annotated, NamedTuple, TypeAlias

from typer import BadParameter, Option

from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.units import quantity_to_si


class Window(NamedTuple):
    """Begin and end of the time that is drawn [s]."""

    begin: float
    end: float


def parse_window(text: str) -> Window:
    """Parse `BEGIN:END`, in seconds.

    Raises:
        BadParameter: The text has another form, or the end is not after the begin.

    >>> parse_window("20:24")
    Window(begin=20.0, end=24.0)
    """
    try:
        begin, end = (_seconds(each) for each in text.split(":"))
    except ValueError:
        raise BadParameter(f"'{text}' is not BEGIN:END in seconds, such as 20:24") from None
    if not begin < end:
        raise BadParameter(f"'{text}' ends at {end:g} s; expected an end after {begin:g} s")
    return Window(begin, end)


class Instants(NamedTuple):
    """Times of snapshots, increasing [s]."""

    t: tuple[float, ...]


def parse_instants(text: str) -> Instants:
    """Parse times in seconds with commas between them; each is kept once.

    Raises:
        BadParameter: A part is not a finite number.

    >>> parse_instants("4,0,8")
    Instants(t=(0.0, 4.0, 8.0))
    """
    try:
        return Instants(tuple(sorted({_seconds(each) for each in text.split(",")})))
    except ValueError:
        raise BadParameter(f"'{text}' is no list of seconds, such as 0,4,8,14") from None


def parse_width(text: str) -> float:
    """Parse a width with its unit; return it in inches.

    Raises:
        UnitError: The text is no length, which Typer tells as it does a `BadParameter`.
        BadParameter: The length is not from 50 to 500 mm.

    >>> round(parse_width("84mm"), 4), round(parse_width("3.5 in"), 4)
    (3.3071, 3.5)
    """
    width = quantity_to_si(text, "m")
    if not 0.05 <= width <= 0.5:
        raise BadParameter(f"'{text}' is not from 50mm to 500mm, with its unit")
    return width / 0.0254


def _seconds(text: str) -> float:
    """Parse a finite number of seconds; raise `ValueError` for any other text."""
    value = float(text)
    if not abs(value) < float("inf"):
        raise ValueError(f"{text} is not finite")
    return value


FormatOption: TypeAlias = Annotated[
    PictureFormat,
    Option("--format", help="Format of the pictures; svg and pdf scale without loss."),
]
"""Annotation of a request's field `form`."""

WidthOption: TypeAlias = Annotated[
    float | None,
    Option(
        parser=parse_width,
        metavar="LENGTH",
        help="Width of the pictures in print, such as 84mm or 3.3in; default: for a screen.",
    ),
]
"""Annotation of a request's field `width` [inch]."""
