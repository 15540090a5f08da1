# SPDX-License-Identifier: MIT
"""Write lines to the terminal, with control characters escaped."""

import typer

from zebro_lab.files.errors import shown


def say(line: str, *, err: bool = False) -> None:
    """Write one line to the terminal; newlines, control and invisible characters are escaped.

    Args:
        line: Text to write, without the newline.
        err: Whether to write to standard error instead of standard output.
    """
    typer.echo(shown(line), err=err)
