# SPDX-License-Identifier: MIT
from benchmarks.tables import print_table


def test_a_table_has_a_head_a_rule_and_its_rows(capsys):
    print_table(("a", "b"), ("1", "2"))
    assert capsys.readouterr().out == "| a | b |\n| --- | ---: |\n| 1 | 2 |\n\n"
