# SPDX-License-Identifier: MIT
"""A plan is foreseen: its points, time, guards that are off, and every step."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from zebro_lab.main import app

THESIS_PLAN = Path(__file__).parents[3] / "examples" / "plan-source.toml"


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


@pytest.fixture(name="plan")
def _plan(tmp_path):
    text = THESIS_PLAN.read_text()
    for old, new in {
        "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [8.0]",
        "slips = { first = 0.0, last = 1.0, count = 62 }": "slips = [0.05, 0.6]",
        "duration = 1.0": "duration = 0.3",
        "tare_duration = 10.0": "tare_duration = 0.3",
        "check_every = 62": "check_every = 0",
        # A busy machine may hold a process up.
        "silence = 0.25": "silence = 3.0\nreading_age = 3.0\nguards_off = "
        '["silence", "reading_age", "speed_error_time"]',
        "speed_error_time = 0.2": "speed_error_time = 2.0",
    }.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "plan.toml"
    file.write_text(text)
    return file


def test_the_sources_plan_is_foreseen():
    result = zebro_lab("plan", THESIS_PLAN)
    assert result.exit_code == 0, result.output
    assert "4 loads x 62 slip ratios" in result.output
    assert "takes about 10 min" in result.output
    assert "every set-point lies within the limits" in result.output


def test_guards_that_are_off_are_named(plan):
    said = "guards that are off, as the plan wants: silence (3 s), reading_age (3 s), speed_error_t"
    assert said in zebro_lab("plan", plan).output
    assert "guards that are off" not in zebro_lab("plan", THESIS_PLAN).output


def test_every_step_is_listed_where_asked(plan):
    lines = zebro_lab("plan", plan, "--steps").output.splitlines()
    assert lines[-3:] == [
        "zero-0001",
        "point-0002 Fn 8 N slip 0.0500",
        "point-0003 Fn 8 N slip 0.6000",
    ]
