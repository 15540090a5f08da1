# SPDX-License-Identifier: MIT
"""Write lines to the terminal, with control characters escaped."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.files.errors import shown

if TYPE_CHECKING:
    from rich.text import Text


def say(line: str, *, err: bool = False) -> None:
    """Write one line to the terminal; newlines, control and invisible characters are escaped.

    Args:
        line: Text to write, without the newline.
        err: Whether to write to standard error instead of standard output.
    """
    typer.echo(shown(line), err=err)


def plain(line: str) -> "Text":
    """Convert a line to Rich text without markup; newlines and control characters are escaped."""
    from rich.text import Text

    return Text(shown(line))
