# SPDX-License-Identifier: MIT
"""Rounds follow each other until enough is known; fits and suggestions are made up here."""

from contextlib import nullcontext
from dataclasses import replace

import pytest

from model.errors import InsufficientData
from rig.experiment.run import Outcome
from support.experiment_plans import short_plan
from support.watchers import Nobody
from zebro_lab.adaptive import stage
from zebro_lab.adaptive.request import AdaptiveRequest
from zebro_lab.experiment.journal import JOURNAL_FILE

DONE = Outcome("completed", 2, (), 2, "sim:rig")
LEAST = 20.0  # s, of a suggestion


class Rig:
    """Measures rounds and fits them: half widths shrink as told."""

    def __init__(self, monkeypatch, widths):
        self.widths, self.experiments, self.suggested = list(widths), [], []
        self.outcomes: list[Outcome] = []
        monkeypatch.setattr(stage.calibration, "calibrate", lambda *_: None)
        monkeypatch.setattr(stage, "_fit", self.fit)
        monkeypatch.setattr(stage.suggestion, "suggest", self.suggest)

    def fit(self, request, *_):
        width = self.widths[len(self.experiments) - 1]
        return {each.text: width for each in request.wanted}, ""

    def suggest(self, request, _watcher):
        if request.time < LEAST:
            raise InsufficientData(f"{request.time:.0f} s are too short")
        self.suggested.append(request)
        request.out.mkdir(exist_ok=True)
        (request.out / "plan.toml").write_text(request.plan.read_text())

    def measure(self, request):
        request.data.mkdir(parents=True, exist_ok=True)
        (request.data / JOURNAL_FILE).touch()
        self.experiments.append(request)
        return self.outcomes.pop(0) if self.outcomes else DONE

    def adapt(self, request):
        return stage.adapt(request, measure=self.measure, working=lambda: nullcontext(Nobody()))


@pytest.fixture
def request_of(tmp_path):
    plan = short_plan(tmp_path)

    def made(*targets, **options):
        return AdaptiveRequest(
            plan, "sim", tmp_path / "data", fast=True, adaptive=targets, **options
        )

    return made


def test_rounds_end_when_every_interval_is_as_narrow_as_asked(monkeypatch, request_of):
    rig = Rig(monkeypatch, [3.0, 0.6, 0.4])
    found = rig.adapt(request_of("slip_stiffness=0.5", budget=1000.0))
    assert found.reached
    assert [each.half_widths["slip_stiffness"] for each in found.rounds] == [3.0, 0.6, 0.4]
    folders = [each.data.name for each in rig.experiments]
    assert folders == ["round-01", "round-02", "round-03"]
    assert [each.out.name for each in rig.suggested] == ["suggested-02", "suggested-03"]


def test_rounds_end_when_the_budget_is_spent_and_it_is_said(monkeypatch, request_of):
    rig = Rig(monkeypatch, [3.0] * 20)
    found = rig.adapt(request_of("slip_stiffness=0.5", budget=200.0))
    assert not found.reached
    assert found.reason.startswith("the budget of 200 s is spent")
    assert sum(each.seconds for each in found.rounds) <= 200.0
    assert len(found.rounds) > 1


def test_a_target_without_a_width_uses_the_budget(monkeypatch, request_of):
    found = Rig(monkeypatch, [3.0] * 20).adapt(request_of("friction"))
    assert found.reached  # nothing was asked that is not
    assert len(found.rounds) > 1


def test_half_of_what_is_left_is_the_most_of_a_round(monkeypatch, request_of):
    rig = Rig(monkeypatch, [3.0, 0.4])
    rig.adapt(request_of("slip_stiffness=0.5", budget=1000.0))
    spent = stage.foresee(rig.experiments[0].plan, "sim").estimate.seconds
    assert rig.suggested[0].time == pytest.approx((1000.0 - spent) / 2)


def test_little_more_is_measured_where_little_is_missing(monkeypatch, request_of):
    rig = Rig(monkeypatch, [0.55, 0.4])
    rig.adapt(request_of("slip_stiffness=0.5", budget=2000.0))
    assert rig.suggested[0].time < 100.0


def test_a_round_that_was_stopped_is_gone_on_with_by_its_own_plan(monkeypatch, request_of):
    rig = Rig(monkeypatch, [3.0, 3.0, 0.4])
    rig.outcomes = [DONE, replace(DONE, reason="safe stop: asked for")]
    first = rig.adapt(request_of("slip_stiffness=0.5", budget=1000.0))
    assert not first.reached
    assert first.stopped is not None
    assert first.stopped.name == "round-02"
    assert len(first.rounds) == 1
    second = rig.adapt(request_of("slip_stiffness=0.5", budget=1000.0, resume=True))
    assert second.reached
    assert [each.data.name for each in rig.experiments] == ["round-01", "round-02", "round-02"]
    assert [each.resume for each in rig.experiments] == [False, False, True]
    assert rig.experiments[1].plan == rig.experiments[2].plan
    assert len(rig.suggested) == 1


def test_an_experiment_that_has_ended_measures_nothing_when_resumed(monkeypatch, request_of):
    rig = Rig(monkeypatch, [0.4])
    rig.adapt(request_of("slip_stiffness=0.5"))
    found = rig.adapt(request_of("slip_stiffness=0.5", resume=True))
    assert (found.reached, found.outcome, len(rig.experiments)) == (True, None, 1)


def test_a_width_that_is_not_known_is_not_reached(monkeypatch, request_of):
    found = Rig(monkeypatch, [float("nan")] * 20).adapt(request_of("curvature=0.1", budget=150.0))
    assert not found.reached
