# SPDX-License-Identifier: MIT
"""Every number of a report names the file and key that it comes from."""

import csv
import json
import tomllib
from pathlib import Path

import pytest

from support.report_pages import made
from zebro_lab.report.numbers import ABSENT, number, spelled


def value_in(file, key):
    path = Path(file)
    text = path.read_text()
    if path.suffix == ".csv":
        content = {row["parameter"]: row for row in csv.DictReader(text.splitlines())}
    else:
        content = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
    for step in key.split("/")[1:]:
        step = step.replace("~1", "/").replace("~0", "~")
        content = content[int(step)] if isinstance(content, list) else content[step]
    return float(content)


def test_every_number_is_that_of_the_file_it_names(walk):
    page = made(walk)
    assert len(page.numbers) > 80
    for attrs, text in page.numbers:
        value = value_in(attrs["data-file"], attrs["data-key"])
        assert float(attrs["value"]) == value
        ratio = float(text) / value
        assert min(abs(ratio / scale - 1) for scale in (1, 100, 1000)) < 0.006, (attrs, text)


def test_counts_are_spelled_whole_and_other_numbers_rounded():
    assert (spelled(62000), spelled(0.012345), spelled(-1234.5, 2)) == ("62000", "0.0123", "-1200")


CONTENT = {
    "runs": {"a/b~c": [0.0123]},
    "count": 62_001,
    "poses": 2315.0,
    "true": True,
    "nan": float("nan"),
    "t": "x",
}


def test_a_number_is_marked_with_its_value_file_and_key():
    found = number(CONTENT, "runs", "a/b~c", 0, file='a"b.json', scale=1000.0)
    assert found == (
        '<data value="0.0123" data-file="a&#34;b.json" data-key="/runs/a~1b~0c/0">12.3</data>'
    )


def test_counts_are_shown_whole_also_those_stored_with_a_point():
    assert ">62001<" in number(CONTENT, "count", file="x", digits=2)
    assert ">2315<" in number(CONTENT, "poses", file="x", rule=round)
    assert ">124000<" in number(CONTENT, "count", file="x", scale=2.0)


@pytest.mark.parametrize("keys", [("none",), ("runs", "a/b~c", 1), ("true",), ("nan",), ("t", "x")])
def test_what_is_no_number_is_a_dash(keys):
    assert number(CONTENT, *keys, file="x") == ABSENT
