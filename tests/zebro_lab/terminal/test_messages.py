# SPDX-License-Identifier: MIT
"""A line on the terminal is one line."""

import pytest

from zebro_lab.terminal.messages import say

HOSTILE = "a\nb \x1b[31m[bold]c[/bold]"
SHOWN = r"a\nb \x1b[31m[bold]c[/bold]"


@pytest.mark.parametrize("err", [False, True])
def test_a_line_is_escaped_and_goes_where_it_should(err, capsys):
    say(HOSTILE, err=err)
    captured = capsys.readouterr()
    expected = ("", SHOWN + "\n") if err else (SHOWN + "\n", "")
    assert captured == expected
