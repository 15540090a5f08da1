# SPDX-License-Identifier: MIT
"""Tables for the terminal."""

import io

from rich.console import Console

from zebro_lab.terminal.tables import plain_table


def test_units_in_brackets_are_shown():
    table = plain_table("a title [bold]", ("leg",), ("touchdown [deg]", "time [s]"))
    table.add_row("1", "50.0", "0.8")
    text = io.StringIO()
    Console(file=text, width=80).print(table)
    for shown in ("a title [bold]", "touchdown [deg]", "time [s]"):
        assert shown in text.getvalue()
