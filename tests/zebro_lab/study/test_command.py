# SPDX-License-Identifier: MIT
"""`study` ends with 3 where a test fails, and prints one document with --json."""

import json

import pytest

from support.made_studies import coverage_of, ranks_of
from zebro_lab.study import stage
from zebro_lab.study.stage import Studied

NAMES = ("slip_stiffness", "friction")


@pytest.fixture
def result_of(monkeypatch):
    """Return what makes both studies end with a result."""

    def ends_with(result):
        studied = Studied("x", result, {"parameters": [1]}, ())
        monkeypatch.setattr(stage, "study_sbc", lambda *_: studied)
        monkeypatch.setattr(stage, "study_coverage", lambda *_: studied)

    return ends_with


@pytest.mark.parametrize(("narrow", "code"), [((), 0), (("friction",), 3)])
@pytest.mark.parametrize(("name", "make"), [("sbc", ranks_of), ("coverage", coverage_of)])
def test_the_exit_code_says_whether_a_test_failed(run_command, result_of, name, make, narrow, code):
    result_of(make(NAMES, narrow=narrow))
    ended = run_command("study", name, "--json", "--quiet", "--out", "there")
    assert ended.code == code
    found = json.loads(ended.out)
    assert found.keys() == {
        "command", "exit_code", "folder", "simulated", "title", "notes", "parameters"
    }  # fmt: skip
    assert (found["command"], found["exit_code"]) == (f"study {name}", code)
    assert found["folder"] == "there"
    assert found["simulated"]


def test_a_scheduler_elsewhere_is_wrong_usage(run_command):
    ended = run_command("study", "sbc", "--scheduler", "here")
    assert ended.code == 2
    assert "expected tcp://HOST:PORT" in ended.err


def test_help_has_examples(run_command):
    ended = run_command("study", "sbc", "--help")
    assert "zebro-lab study sbc --plan plan.toml" in ended.out
    assert "tcp://" in ended.out
