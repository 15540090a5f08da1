# SPDX-License-Identifier: MIT
"""Generated inputs are read or refused, and a reader that does neither is reported."""

import tomllib

import pytest

from benchmarks.faults.device_parsers import Parser
from benchmarks.faults.fuzz import main, run

DOCUMENTS = [b'a = 1\nb = ["x", 2.0]\n', b"[t]\nc = 3\n"]


def careless(data: bytes) -> bool:
    """Read TOML, whose errors alone are expected, and trust what is in it."""
    return tomllib.loads(data.decode(errors="replace"))["a"] > 0


def test_a_reader_that_trusts_its_input_is_reported():
    outcome = run(Parser(lambda: careless, DOCUMENTS, (tomllib.TOMLDecodeError,)), 200, seed=1)
    assert not outcome.good
    assert outcome.inputs == 200
    assert {each.split()[0] for each in outcome.faults} >= {"KeyError", "TypeError"}


def test_a_reader_that_takes_all_memory_or_ends_its_process_is_reported():
    def hungry(data: bytes) -> bool:
        return bool(b"x" * (1 << 30))

    def deadly(data: bytes) -> bool:
        raise SystemExit(3)

    assert not run(Parser(lambda: hungry, DOCUMENTS), 1, seed=1).good
    assert run(Parser(lambda: deadly, DOCUMENTS), 1, seed=1).faults == {"process ended with 3": 1}


def test_a_few_generated_inputs_are_read_or_refused(rows):
    assert main(["--inputs", "50", "--only", "leg"]) == 0
    assert {row[0] for row in rows()} >= {"profile of legs", "CSV of legs", "leg packets"}


@pytest.mark.long
def test_many_generated_inputs_are_read_or_refused(rows):
    assert main(["--inputs", "500"]) == 0
    assert len(rows()) > 40
