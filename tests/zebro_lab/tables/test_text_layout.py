# SPDX-License-Identifier: MIT
"""The header, the units and the separator of a text are found, or the text is refused."""

import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.tables.text_layout import BLANKS, find_layout


def lines(text: str) -> list[tuple[int, str]]:
    return [(i, line) for i, line in enumerate(text.split("\n"), start=1) if line.strip()]


@pytest.mark.parametrize(
    ("text", "separator", "names", "last_line", "decimal"),
    [
        ("t,F\n0.5,1\n", ",", "t F", 1, "."),
        ("t,F\n", ",", "t F", 1, None),
        ("photo,t_s\na.jpg,0\nb.jpg,1\n", ",", "photo t_s", 1, None),
        ("x\n0,5\n0,7\n", ";", "x", 1, ","),
        ("a,b;c\n1,2;3\n", ";", "a,b c", 1, ","),
        ("t|F\n1|2\n", "|", "t F", 1, None),
        ("Run 5\n  t  F\n  1  2\n  2  3\n", BLANKS, "t F", 2, None),
        (
            "Elapsed Time  Normal Force\n0.5  1\n1.5  2\n",
            BLANKS,
            "Elapsed Time Normal Force",
            1,
            ".",
        ),
        ("sep=;\nt;F\n1;2\n", ";", "t F", 2, None),
        ("# pose\n# t x y\n1.5 2 3\n2.5 3 4\n", BLANKS, "t x y", 2, "."),
        ("%time,field.x\n12,0.5\n13,0.6\n", ",", "time field.x", 1, "."),
        ("Operator,1\nRate,1000\nA,3\nt,F,x\n0,1,2\n1,2,3\n", ",", "t F x", 4, None),
        ("t,F,x\n0,1,2\nstart,walk,now\n1,2,3\n2,3,4\n", ",", "t F x", 1, None),
        ("t,1,2\n0,.1,.2\n1,.1,.2\n", ",", "t 1 2", 1, "."),
        ("t,leg,phase\n0,a,b\n1,a,b\n", ",", "t leg phase", 1, None),
        ("time,FZ\n2026-03-04 12:00:00.5,1\n2026-03-04 12:00:01,2\n", ",", "time FZ", 1, None),
    ],
)
def test_header_and_separator_are_found(text, separator, names, last_line, decimal):
    layout = find_layout(lines(text))
    assert (layout.separator, " ".join(layout.header.names)) == (separator, names)
    assert (layout.last_line, layout.decimal) == (last_line, decimal)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "is empty or all comments"),
        ("# a\n# b\n", "is empty or all comments"),
        ("1.5 2\n2.5 3\n", "has no header: the first line is '1.5 2'"),
        ("a,b;c\nx,y;z\n", "commas or by semicolons"),
        ("Zeit;Kraft\ntime;force\n1;2\n", "two rows above the numbers that may be the header"),
        ("t,F\n0,1,5,2\n0,2,5,3\n", "has 4 cells, the header has 2; write decimals with a point"),
        ('"a" "b"\n"1" 0.5 0.6\n"2" 0.5 0.6\n', "has 3 cells, the header has 2"),
        (
            "t,0,1,2\nF,5,6,7\n",
            "has a name at the start of each line, 't' first, and is transposed",
        ),
        ("a,0,1,2\na,5,6,7\n", "has no header: the first line"),
        ("t,F\nn/m,\n1,2\n3,4\n", "line 2, 'n/m,', stands between names and numbers"),
        ("Time, s,F, N,G, N\n0,1,2\n1,2,3\n", r"write units in brackets: 'Time \[s\]'"),
        ("t;F\n1;2\n1;2;3\n", "has 3 cells, the header has 2"),
    ],
)
def test_an_unclear_layout_is_refused(text, problem):
    with pytest.raises(DataError, match=problem.replace("(", r"\(")):
        find_layout(lines(text))
