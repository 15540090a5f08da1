# SPDX-License-Identifier: MIT
"""The terminal shows each parameter, what was left out, and the verdict."""

from io import StringIO
from pathlib import Path

from rich.console import Console

from support.made_studies import coverage_of, ranks_of
from zebro_lab.study.screen import lines, print_study
from zebro_lab.study.stage import Studied

NAMES = ("slip_stiffness", "friction")


def printed(result):
    console = Console(width=100, file=StringIO())
    print_study(console, Studied("plan 'x'", result, {}, ("a note",)), Path("out"))
    return console.file.getvalue()


def test_ranks_are_shown_with_their_p_values():
    text = printed(ranks_of(NAMES, narrow=("friction",)))
    assert text.startswith("SIMULATED experiments: plan 'x'")
    assert "intervals too narrow" in text
    assert "ranks of 120 fits; a test fails at p below 0.005" in text
    assert "1 of 121 fits left out: 1 failed, 0 without reliable weights" in text
    assert "failed: friction (intervals too narrow)" in text
    assert "written to out" in text


def test_coverage_is_shown_with_its_band():
    text = printed(coverage_of(NAMES))
    assert "99 % of a count, 50 %: 20 to 40, 90 %: 47 to 59" in " ".join(text.split())
    assert "all 60 fits have reliable weights" in text
    assert "passed: intervals of all 2 parameters" in text


def test_the_verdict_is_the_last_line():
    said = lines(Studied("x", ranks_of(NAMES), {}, ("a note",)))
    assert said[0] == "a note"
    assert said[-1].startswith("passed")
