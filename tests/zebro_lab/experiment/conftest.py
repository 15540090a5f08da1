# SPDX-License-Identifier: MIT
"""What the tests of experiments share: a small plan, and a run of it on a twin without waiting."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from rig.experiment.control import Control
from rig.experiment.watcher import ExperimentWatcher
from zebro_lab.experiment.journal import JOURNAL_FILE
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.stage import run_experiment

THESIS_PLAN = Path(__file__).parents[3] / "examples" / "plan-thesis.toml"
SMALL = {
    "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [4.0, 8.0]",
    "slips = { first = 0.0, last = 1.0, count = 62 }": "slips = [0.02, 0.1, 0.6]",
    "duration = 1.0": "duration = 0.2",
    "tare_duration = 10.0": "tare_duration = 0.3",
    "check_every = 62": "check_every = 0",
    "tolerance = 0.3": "tolerance = 8.0",
    "friction = 0.15": "friction = 0.4",
    "slip_drift = 0.02": "slip_drift = 0.05",
    "friction_drift = 0.2": "friction_drift = 0.5",
    # A busy machine may hold a process up.
    "silence = 0.25": "silence = 3.0\nreading_age = 3.0\nguards_off = "
    '["silence", "reading_age", "speed_error_time"]',
    "speed_error_time = 0.2": "speed_error_time = 2.0",
}


@pytest.fixture(name="plan")
def _plan(tmp_path):
    text = THESIS_PLAN.read_text()
    for old, new in SMALL.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "plan.toml"
    file.write_text(text)
    return file


def run(plan, data, *, watcher=None, control=None, **options):
    request = RigRunRequest(plan, "sim", data, fast=True, **options)
    return run_experiment(request, watcher or ExperimentWatcher(), control or Control())


class StopAfter(ExperimentWatcher):
    """Asks for a stop after so many points."""

    def __init__(self, count, action):
        self.count, self.action = count, action

    def judged(self, point, verdict, *, attempt):
        self.count -= 1
        if self.count == 0:
            self.action()


def journal(data):
    return [json.loads(line) for line in (data / JOURNAL_FILE).read_text().splitlines()]


@pytest.fixture(name="lab")
def _lab():
    """Return what runs a plan, stops it after some points, and reads its journal."""
    return SimpleNamespace(run=run, StopAfter=StopAfter, journal=journal)
