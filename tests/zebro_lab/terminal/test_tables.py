# SPDX-License-Identifier: MIT
"""Tables for the terminal."""

import io

from rich.console import Console

from zebro_lab.terminal.tables import plain, plain_table


def test_units_in_brackets_are_shown():
    table = plain_table("a title [bold]", ("leg",), ("touchdown [deg]", "time [s]"))
    table.add_row("1", "50.0", "0.8")
    text = io.StringIO()
    Console(file=text, width=80).print(table)
    for shown in ("a title [bold]", "touchdown [deg]", "time [s]"):
        assert shown in text.getvalue()


def test_markup_and_control_characters_in_a_line_are_text_to_rich():
    assert plain("a\nb \x1b[31m[bold]c[/bold]").plain == r"a\nb \x1b[31m[bold]c[/bold]"
    assert plain("[bold]c[/bold]").spans == []
