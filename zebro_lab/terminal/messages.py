# SPDX-License-Identifier: MIT
"""Write lines to the terminal; text of files in them can do nothing but be read."""

import typer

from zebro_lab.files.shown_text import shown


def say(line: str, *, err: bool = False) -> None:
    """Write one line; a newline inside it, and whatever else is no character, is spelled out.

    Args:
        line: The line.
        err: Write to the standard error.
    """
    typer.echo(shown(line), err=err)
