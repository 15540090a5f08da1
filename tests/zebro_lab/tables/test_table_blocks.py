# SPDX-License-Identifier: MIT
"""Headings between the rows of a text table begin runs."""

import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.tables.table_files import read_table_file


@pytest.mark.parametrize(
    ("lines", "runs"),
    [
        ("t,F|1,2|3,4|t,F|1,5|3,6", "1122"),
        ("t;F|s;N|1;2|3;4||t;F|s;N|1;5|3;6", "1122"),
        ("first|t,F|1,2|3,4|second|1,5|3,6|third,,|1,7", "first first second second third"),
        ("||t,F|1,2||3,4||t,F|1,5", "112"),
        ("one,|t,F|1,2|3,4|,|two,|t,F|1,5", "one one two"),
        ("E,t,F|1,2,3|E,t,F|1,5,3", "12"),
        ("10 N,|t,F|1,2|20 N,|1,5", "10 N,20 N"),
        ("10 N|t,F|1,2|3,4|20 N|t,F|1,5|20 N|t,F|3,6", "10 N,10 N,20 N,20 N (2)"),
        ("# run 1|t F|1 2|# run 2|1 5|3 6", "1,run 2,run 2"),
        ("t F v|1 2 0|Load 20|1 5 0|3 6 0", "1,Load 20,Load 20"),
        ("t,F,v|1,2,0|Load [N],20|1,5,0", "1,Load [N] 20"),
    ],
)
def test_headings_begin_runs(tmp_path, lines, runs):
    file = tmp_path / "rig.dat"
    file.write_text(lines.replace("|", "\n") + "\n")
    expected = runs.split(",") if "," in runs else runs.split() if " " in runs else list(runs)
    table = read_table_file(file)
    assert table.columns["run"].tolist() == expected
    assert {table.numbers(name).dtype.kind for name in ("t", "F")} == {"f"}
    assert "tables with headings between them are runs, in column 'run'" in " ".join(table.notes)
    last = len(expected) - 1
    assert table.fault("is bad", "F", last).line == 1 + lines.count("|")


@pytest.mark.parametrize(
    ("lines", "problem"),
    [
        ("t,F|1,2|t,v|1,5", "line 3, 't v', is not the header above the rows"),
        ("t,F,v|1,2,3|ERR,5,6|1,5,3", "row 2 .*'ERR' is not a number"),
        ("t,F,v|1,2,3|Mean,5,6|1,5,3", "row 2 .*'Mean' stands below numbers"),
        ("t,F|1,2|,|3,4|x,5", "row 4 .*'x' is not a number"),
        ("t,F|1,2|end,|", "'end' stands below numbers"),
    ],
)
def test_what_is_no_heading_is_refused(tmp_path, lines, problem):
    file = tmp_path / "rig.csv"
    file.write_text(lines.replace("|", "\n") + "\n")
    with pytest.raises(DataError, match=problem):
        read_table_file(file).numbers("t")


def test_rows_that_begin_with_words_are_no_headings(tmp_path):
    file = tmp_path / "rig.csv"
    file.write_text("tyre,F,v\na,1,2\nb,,\nc,3,4\n")
    assert read_table_file(file).columns["tyre"].tolist() == ["a", "b", "c"]


LABVIEW = """LabVIEW Measurement\t
X_Columns\tNo
***End_of_Header***\t

Channels\t2\t\t
Samples\t2\t2\t
Y_Unit_Label\tN\tmN\t
X_Dimension\tTime\tTime\t
X0\t{x0}\t{x0}\t
Delta_X\t0,05\t{step}\t
***End_of_Header***\t\t\t
X_Value\tFz\tFx\tComment
\t5,01\t395\t
\t4,95\t396\t
"""


def test_times_that_labview_leaves_out_are_those_of_its_steps(tmp_path):
    first = LABVIEW.format(x0="0,0E+0", step="0,05")
    again = LABVIEW.format(x0="1,0E+1", step="0,05")
    file = tmp_path / "rig.lvm"
    file.write_text(first + "\n" + again[again.index("Channels") :])
    table = read_table_file(file)
    assert table.numbers("X_Value").tolist() == pytest.approx([0.0, 0.05, 10.0, 10.05])
    assert table.columns["run"].tolist() == ["1", "1", "2", "2"]
    assert dict(table.units) == {"X_Value": "s", "Fz": "N", "Fx": "mN"}
    file.write_text(LABVIEW.format(x0="0", step="0,1"))  # two rates: there is no time of a row
    assert list(read_table_file(file).columns) == ["Fz", "Fx", "Comment"]


def test_a_segment_of_other_channels_is_refused(tmp_path):
    file = tmp_path / "rig.lvm"
    first = LABVIEW.format(x0="0", step="0,05")
    file.write_text(first + first[first.index("Channels") :].replace("Fx", "Fy"))
    with pytest.raises(DataError, match="'X_Value Fz Fy Comment', is not the header"):
        read_table_file(file)
