# SPDX-License-Identifier: MIT
import contextlib
import io
import os
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from typer.testing import CliRunner

from rig.experiment.control import Control
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict
from rig.safety import StopCategory
from rig.twins import simulated_rig_devices
from zebro_lab.experiment.check_stage import check_runs
from zebro_lab.experiment.screen import ExperimentScreen, experiment_screen, slip_chart
from zebro_lab.experiment.stage import RigRunRequest, run_experiment
from zebro_lab.main import app

SOURCE_PLAN = Path(__file__).parents[3] / "examples" / "plan-source.toml"


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


@pytest.fixture(name="plan")
def _plan(tmp_path):
    text = SOURCE_PLAN.read_text()
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
    result = zebro_lab("plan", SOURCE_PLAN)
    assert result.exit_code == 0, result.output
    assert "4 loads x 62 slip ratios" in result.output
    assert "takes about 10 min" in result.output
    assert "every set-point lies within the limits" in result.output


def test_guards_that_are_off_are_named(plan):
    said = "guards that are off, as the plan wants: silence (3 s), reading_age (3 s), speed_error_t"
    assert said in zebro_lab("plan", plan).output
    assert "guards that are off" not in zebro_lab("plan", SOURCE_PLAN).output


def test_every_step_is_listed_where_asked(plan):
    lines = zebro_lab("plan", plan, "--steps").output.splitlines()
    assert lines[-3:] == [
        "zero-0001",
        "point-0002 Fn 8 N slip 0.0500",
        "point-0003 Fn 8 N slip 0.6000",
    ]


def test_a_run_says_what_each_point_is_worth(plan, tmp_path):
    result = zebro_lab("run", plan, "--rig", "sim", "--fast", "--data", tmp_path / "data")
    assert result.exit_code == 0, result.output
    assert "point-0002 Fn 8 N slip 0.0500 (attempt 1): good" in result.output
    assert "completed: 2 points finished, 0 refused" in result.output


def test_refused_points_have_an_exit_code_of_their_own(plan, tmp_path):
    plan.write_text(plan.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    result = zebro_lab("run", plan, "--rig", "sim", "--fast", "--data", tmp_path / "data")
    assert result.exit_code == 3
    assert "2 refused" in result.output


def test_a_weighing_prints_line_and_prior():
    result = zebro_lab("weigh", "--rig", "sim", "--fast", "--masses", "0.2,1")
    assert result.exit_code == 0, result.output
    assert "[load_cell]" in result.output
    assert zebro_lab("weigh", "--rig", "sim", "--masses", "one").exit_code == 2


def test_a_short_run_in_real_time_takes_its_time(plan, tmp_path, monkeypatch):
    patient = partial(simulated_rig_devices, watchdog=3.0)
    monkeypatch.setattr("zebro_lab.experiment.rig_at_hand.simulated_rig_devices", patient)
    began = time.monotonic()
    result = zebro_lab("run", plan, "--rig", "rig-odrive-netft@sim", "--data", tmp_path / "data")
    assert result.exit_code == 0, result.output
    assert time.monotonic() - began > 1.5
    assert "completed: 2 points finished" in result.output


def test_nobody_to_talk_to_is_said(tmp_path):
    result = zebro_lab("say", "pause", "--data", tmp_path)
    assert "no experiment runs here" in str(result.exception)


def test_help_loads_nothing_heavy():
    code = (
        "import sys; from typer.testing import CliRunner; from zebro_lab.main import app; "
        "CliRunner().invoke(app, ['rig', 'run', '--help']); "
        "print([m for m in ('numpy', 'can', 'scipy', 'rich.live') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_chart_puts_the_largest_friction_on_top():
    chart = slip_chart([(4.0, 0.0, 0.0), (4.0, 0.5, 0.4), (8.0, 1.0, 0.3)])
    rows = chart.splitlines()
    assert rows[0].endswith("o 4 N, x 8 N")
    assert "o" in rows[1]
    assert rows[-1].startswith("o")


def test_a_terminal_sees_progress_prompt_and_curve():
    console = Console(file=io.StringIO(), force_terminal=True, width=100)
    with experiment_screen(console, Control()) as screen:
        screen.doing("point-0001", done=1, of=4, left=75.0)
        screen.prompt("set it", normal=3.2)
        verdict = PointVerdict((), 100, 0.1, 0.3, 4.0)
        screen.judged(Point(1, 4.0, (0.1,)), verdict, attempt=1)
    shown = console.file.getvalue()
    assert "1 of 4 points, 1:15 left" in shown
    assert "set it; now 3.20 N" in shown
    assert "friction 0.00 to 0.30" in shown


def test_without_a_terminal_a_prompt_is_one_line():
    console = Console(file=io.StringIO())
    screen = ExperimentScreen(console, None)
    for normal in (1.0, 2.0, 3.0):
        screen.prompt("set it", normal=normal)
    screen.draw()
    assert console.file.getvalue() == "set it\n"


def test_text_of_a_plan_cannot_command_the_terminal():
    console = Console(file=io.StringIO())
    screen = ExperimentScreen(console, None)
    screen.notice("a [red]label\x1b[2J\ncompleted")
    screen.draw()
    assert console.file.getvalue() == "a [red]label\\x1b[2J\\ncompleted\n"


def test_a_pipe_that_nobody_reads_is_named(monkeypatch):
    # Rich puts /dev/null in the place of the standard output, which here is the tests' own.
    monkeypatch.setattr(os, "dup2", lambda *_: None)
    read, write = os.pipe()
    os.close(read)
    with contextlib.suppress(BrokenPipeError), os.fdopen(write, "w") as pipe:
        screen = ExperimentScreen(Console(file=pipe), None)
        screen.notice("begin")
        screen.close()
        with pytest.raises(BrokenPipeError, match="nobody reads"):
            screen.draw_on()


@pytest.mark.parametrize("closed", ["<&-", ">&-"])
def test_a_stream_that_a_shell_has_closed_is_no_fault(plan, tmp_path, closed):
    command = (
        f"{sys.executable} -c 'from zebro_lab.main import main; main()' rig run {plan} --rig sim "
        f"--fast --data {tmp_path / 'data'} {closed}"
    )
    done = subprocess.run(["sh", "-c", command], stderr=subprocess.PIPE, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_hold_is_visible_and_says_which_key_goes_on(plan, tmp_path):
    control = Control()

    class Holding(ExperimentScreen):
        def judged(self, point, verdict, *, attempt):
            super().judged(point, verdict, attempt=attempt)
            control.stop.request(StopCategory.SOFT, "Ctrl-C, time 1")

    plan.write_text(plan.read_text().replace("hold = 600.0", "hold = 1.0"))
    console = Console(file=io.StringIO(), width=200)
    request = RigRunRequest(plan, "sim", tmp_path / "data", fast=True)
    screen = Holding(console, None)
    run_experiment(request, screen, control)
    screen.draw()
    shown = console.file.getvalue()
    assert "HOLDING" in shown
    assert "discs energised" in shown
    assert "r: go on" in shown
    assert "safe stop" in shown


def test_a_rig_that_lost_friction_has_drifted(plan, tmp_path, monkeypatch):
    from dataclasses import replace

    from zebro_lab.calibration.slip_argument import source_curve
    from zebro_lab.experiment import check_stage as rig_check

    data = tmp_path / "data"
    assert zebro_lab("run", plan, "--rig", "sim", "--fast", "--data", data).exit_code == 0
    curve = source_curve()
    monkeypatch.setattr(rig_check, "read_slip", lambda path: curve)
    assert not any(found.drifted for found in check_runs([data], tmp_path))
    slippery = replace(curve, values=curve.values * np.array([1.0, 1.0, 0.6, 1.0]))
    monkeypatch.setattr(rig_check, "read_slip", lambda path: slippery)
    assert all(found.drifted for found in check_runs([data], tmp_path))
    result = zebro_lab("check", data, "--slip", tmp_path)
    assert result.exit_code == 3
    assert "2 of 2 runs have drifted" in result.output
