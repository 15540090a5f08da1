# SPDX-License-Identifier: MIT
"""`expected.csv` has one row a part of a target; a suggestion in numbers has its points."""

import csv

from zebro_lab.suggest.folder import Expected, write_expected


def test_numbers_and_names_are_columns(tmp_path):
    rows = [Expected("friction", "friction", "dimensionless", 0.1, 0.05, 1 / 30),
            Expected("walk:run", "x", "m", 1.0, 0.5, 0.25)]  # fmt: skip
    write_expected(tmp_path / "expected.csv", rows)
    with (tmp_path / "expected.csv").open(newline="") as file:
        found = list(csv.DictReader(file))
    assert [row["part"] for row in found] == ["friction", "x"]
    assert found[0]["sd_suggested"] == "0.0333333"
    assert list(found[0]) == ["target", "part", "unit", "sd_now", "sd_plan", "sd_suggested"]
