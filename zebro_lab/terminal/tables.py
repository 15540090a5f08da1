# SPDX-License-Identifier: MIT
"""Tables of results; text is shown as it is, also units in brackets."""

from collections.abc import Sequence

from rich import box
from rich.table import Table
from rich.text import Text

from zebro_lab.files.errors import shown


def plain(line: str) -> Text:
    """Convert a line to Rich text without markup; newlines and control characters are escaped."""
    return Text(shown(line))


def plain_table(
    title: str,
    names: Sequence[str],
    numbers: Sequence[str],
    *,
    fold: bool = False,
    no_wrap: bool = False,
) -> Table:
    """Create a Rich table with headings but without rows.

    Rich takes a unit such as `[mm]` in a plain string for markup and hides it.

    Args:
        title: Title of the table.
        names: Headings of columns of text, which come first.
        numbers: Headings of columns of numbers, aligned to the right; a line break keeps a column
            of a long heading narrow.
        fold: Whether long text is folded; otherwise it is kept on one line.
        no_wrap: Whether numbers and their headings are kept on one line.
    """
    table = Table(title=plain(title), box=box.SIMPLE, title_justify="left")
    for name in names:
        table.add_column(plain(name), no_wrap=not fold, overflow="fold")
    for name in numbers:
        heading = Text("\n").join(map(plain, name.split("\n")))
        table.add_column(heading, justify="right", no_wrap=no_wrap)
    return table
