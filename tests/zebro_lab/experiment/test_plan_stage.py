# SPDX-License-Identifier: MIT
"""A plan is foreseen: its points, time, guards that are off, and every step."""

import pytest
from typer.testing import CliRunner

from support.experiment_plans import THESIS_PLAN
from zebro_lab.experiment.plan_stage import read_plan
from zebro_lab.files.errors import SettingsError
from zebro_lab.main import app


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


def test_the_sources_plan_is_foreseen():
    result = zebro_lab("plan", THESIS_PLAN)
    assert result.exit_code == 0, result.output
    assert "4 loads x 62 slip ratios" in result.output
    assert "takes about 12 min" in result.output
    assert "limits of the plan, which all set-points keep" in result.output


def test_guards_that_are_off_are_named(short):
    said = "guards switched off by the plan: silence (3 s), reading_age (3 s), speed_error_t"
    assert said in zebro_lab("plan", short).output
    assert "guards switched off" not in zebro_lab("plan", THESIS_PLAN).output


def test_every_step_is_listed_where_asked(short):
    lines = zebro_lab("plan", short, "--steps").output.splitlines()
    assert lines[-3:] == [
        "zero-0001",
        "point-0002 Fn 8 N slip 0.0500",
        "point-0003 Fn 8 N slip 0.6000",
    ]


def test_an_unknown_key_names_file_key_and_the_nearest(plan):
    plan.write_text(plan.read_text().replace("acceleration =", "aceleration ="))
    with pytest.raises(SettingsError, match=r"plan\.toml, limits\.acceleration: is missing"):
        read_plan(plan)
    plan.write_text(plan.read_text() + "acceleration = 40.0\n")
    with pytest.raises(SettingsError, match="aceleration: unknown key; did you mean 'accelera"):
        read_plan(plan)
