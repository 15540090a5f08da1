# SPDX-License-Identifier: MIT
"""Zeros, settling and recording on a twin."""

import numpy as np
import pytest

from rig.errors import ProtocolError
from rig.experiment.measure import record, settle, take_zero
from rig.experiment.sink import RunStart
from rig.experiment.steps import Point
from rig.slip_rig.decode import Zero

NO_ZERO = Zero(0.0, 0.0, 0.0)


def test_a_zero_is_the_mean_of_an_unloaded_cell_and_its_error_is_small(lab):
    twin = lab["twin"]()
    twin.rig.load = 1e-3
    with twin.bench:
        acquire = twin.acquisition(lab["plan"]())
        acquire.arm()
        zero = take_zero(acquire, 0.5)
    assert abs(zero.normal) < 0.05
    assert 0 < zero.standard_error < 0.05


def test_a_cell_that_sends_nothing_gives_no_zero(lab, monkeypatch):
    twin = lab["twin"]()
    monkeypatch.setattr(twin.board, "_frames", lambda due: [])
    with twin.bench, pytest.raises(ProtocolError, match="found 0 forces for a zero"):
        take_zero(twin.acquisition(lab["plan"]()), 0.1)


def test_discs_settle_before_the_timeout_or_not_at_all(lab):
    twin, plan = lab["twin"](), lab["plan"]()
    impossible = lab["plan"](settle={"speed": 1e-9})
    with twin.bench:
        acquire = twin.acquisition(plan)
        acquire.arm()
        point = Point(1, 8.0, (0.2,))
        assert settle(acquire, plan, point, NO_ZERO)
        began = twin.clock.now()
        assert not settle(acquire, impossible, point, NO_ZERO)
    assert twin.clock.now() - began == pytest.approx(plan.settle.timeout, abs=0.1)


def test_a_recording_lasts_as_planned_and_reaches_the_sink_without_its_zero(lab):
    twin, plan = lab["twin"](), lab["plan"]()
    twin.rig.load, zero = 8.0, Zero(100.0, 50.0, 0.0)
    with twin.bench:
        acquire = twin.acquisition(plan)
        acquire.arm()
        point = Point(1, 8.0, (0.2,))
        settle(acquire, plan, point, NO_ZERO)
        twin.sink.open_run(RunStart(point, 1, twin.clock.now(), zero))
        readings = record(acquire, twin.sink, plan, point, zero, clock=twin.clock)
    kept = twin.sink.runs[-1].readings
    assert np.array_equal(kept.normal_force, readings.normal_force)
    duration = plan.points.duration
    assert readings.t[-1] - readings.t[0] == pytest.approx(duration, abs=0.05)
    assert np.median(readings.normal_force) == pytest.approx(8.0 - 100.0, abs=2.0)
