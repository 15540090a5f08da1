# SPDX-License-Identifier: MIT
"""`expected.csv` has one row a part of a target; a suggestion in numbers has its points."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from support.suggestions import write_plan
from zebro_lab.experiment.plan_stage import read_plan
from zebro_lab.files.errors import DataError
from zebro_lab.suggest.folder import Expected, with_points, write_expected


def test_numbers_and_names_are_columns(tmp_path):
    rows = [Expected("friction", "friction", "dimensionless", 0.1, 0.05, 1 / 30),
            Expected("walk:run", "x", "m", 1.0, 0.5, 0.25)]  # fmt: skip
    write_expected(tmp_path / "expected.csv", rows)
    with (tmp_path / "expected.csv").open(newline="") as file:
        found = list(csv.DictReader(file))
    assert [row["part"] for row in found] == ["friction", "x"]
    assert found[0]["sd_suggested"] == "0.0333333"
    assert list(found[0]) == ["target", "part", "unit", "sd_now", "sd_plan", "sd_suggested"]


SLIPS = tuple(np.round(np.linspace(0, 0.3, 30), 4).tolist())


def changed(file, **points):
    plan = read_plan(file)
    given = {"slips": SLIPS, "loads": (4.0, 12.0), "duration": 0.42, "repeats": 1, **points}
    wanted = replace(plan, points=replace(plan.points, **given))
    return wanted, with_points(file.read_text(), wanted, file=file)


def test_all_but_the_points_stays_verbatim(tmp_path):
    file = write_plan(tmp_path)
    wanted, text = changed(file)
    head, _, rest = file.read_text().partition("[points]")
    _, _, tail = rest.partition("[load]")
    assert text.startswith(f"{head}[points]")
    assert text.endswith(f"[load]{tail}")
    assert "# rad/s\n" in text
    (tmp_path / "new.toml").write_text(text)
    assert read_plan(tmp_path / "new.toml") == wanted
    assert max(map(len, text.splitlines())) < 130


def test_turns_become_seconds_and_repeats_one(tmp_path):
    file = write_plan(
        tmp_path,
        ('length = "duration"', 'length = "turns"'),
        ("duration = 1.0 ", "turns = 2.0 "),
        ("repeats = 1", "repeats = 3"),
    )
    wanted, text = changed(file)
    assert "turns = " not in text
    assert "repeats = 1\n" in text
    (tmp_path / "new.toml").write_text(text)
    assert read_plan(tmp_path / "new.toml") == wanted


def test_an_inline_table_of_points_is_replaced_too(tmp_path):
    file = write_plan(tmp_path)
    head, _, rest = file.read_text().partition("[points]")
    points = (
        'points = { loads = [4.0, 12.0], slips = [0.0, 0.3], omega_leg = 12.0, length = "duration",'
        ' duration = 1.0, order = "monotone" }\n'
    )
    file.write_text(head + points + "[load]" + rest.partition("[load]")[2])
    wanted, text = changed(file)
    (tmp_path / "new.toml").write_text(text)
    assert read_plan(tmp_path / "new.toml") == wanted


def test_a_plan_that_differs_elsewhere_is_noticed(tmp_path):
    file = write_plan(tmp_path)
    wanted = replace(read_plan(file), name="another")
    with pytest.raises(DataError, match="states its points in a way that cannot be replaced"):
        with_points(file.read_text(), wanted, file=file)
