# SPDX-License-Identifier: MIT
"""What the tests of experiments share: a small plan, and a run of it on a twin without waiting."""

import json
from types import SimpleNamespace

import pytest

from rig.experiment.control import Control
from rig.experiment.sink import ExperimentWatcher
from support.experiment_plans import LENIENT, short_plan
from zebro_lab.experiment.journal import JOURNAL_FILE
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.stage import run_experiment


@pytest.fixture(name="plan")
def _plan(tmp_path):
    slips = {"loads": "[4.0, 8.0]", "slips": "[0.02, 0.1, 0.6]"}
    return short_plan(tmp_path, **slips, duration="0.2", tolerance="8.0", **LENIENT)


@pytest.fixture
def short(tmp_path):
    """Write a plan of two points that the criteria of the thesis's plan judge."""
    return short_plan(tmp_path)


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
