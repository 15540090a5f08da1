# SPDX-License-Identifier: MIT
"""Write lines to the terminal; text of files in them can do nothing but be read."""

from typing import TYPE_CHECKING

import typer

from zebro_lab.files.shown_text import shown

if TYPE_CHECKING:
    from rich.text import Text


def say(line: str, *, err: bool = False) -> None:
    """Write one line; a newline inside it, and whatever else is no character, is spelled out.

    Args:
        line: The line.
        err: Write to the standard error.
    """
    typer.echo(shown(line), err=err)


def plain(line: str) -> "Text":
    """Return one line for a console of Rich, without markup, made harmless as by `say`."""
    from rich.text import Text

    return Text(shown(line))
