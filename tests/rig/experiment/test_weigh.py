# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError, RigError, RigTimeout
from rig.experiment.weigh import Weighing, check_gain, weigh

FORCES = (0.0, 2.0, 5.0, 10.0)


@given(st.floats(0.9, 1.1), st.floats(-0.5, 0.5))
def test_a_straight_line_is_found_exactly(slope, zero):
    readings = tuple(zero + slope * force for force in FORCES)
    check = check_gain(Weighing(FORCES, readings, (0.01,) * 4, "real"))
    assert check.slope == pytest.approx(slope, abs=1e-9)
    assert check.zero == pytest.approx(zero, abs=1e-9)
    assert check.misfit < 1e-9
    assert check.gain_sd == pytest.approx(np.hypot(slope - 1, check.slope_sd))


def test_the_error_of_the_slope_is_that_of_many_weighings():
    rng = np.random.default_rng(0)
    found = [
        check_gain(
            Weighing(FORCES, tuple(rng.normal(FORCES, 0.02)), (0.02,) * 4, "real"), weight_sd=0.0
        )
        for _ in range(400)
    ]
    slopes = [check.slope for check in found]
    stated = np.median([check.slope_sd for check in found])
    assert np.std(slopes) == pytest.approx(stated, rel=0.25)
    assert np.mean(slopes) == pytest.approx(1.0, abs=3 * stated / 20)


def test_what_hangs_askew_widens_the_error():
    straight = check_gain(Weighing(FORCES, FORCES, (0.001,) * 4, "real"), weight_sd=0.0)
    askew = check_gain(Weighing(FORCES, (0.0, 2.1, 4.9, 10.0), (0.001,) * 4, "real"), weight_sd=0.0)
    assert askew.slope_sd > 10 * straight.slope_sd
    assert askew.misfit > 0.05


def test_the_weights_own_error_stays_in_the_slopes():
    check = check_gain(Weighing(FORCES, FORCES, (1e-6,) * 4, "real"), weight_sd=0.01)
    assert check.slope_sd == pytest.approx(0.01, rel=1e-3)


def test_no_weight_at_all_is_refused():
    with pytest.raises(ProtocolError, match="expected one above 0 N"):
        check_gain(Weighing((0.0,), (0.1,), (0.01,), "real"))


def test_a_gain_error_of_the_twin_is_weighed(lab):
    from rig.experiment.load import SimulatedOperator

    twin = lab["twin"]()
    twin.rig.command("leg", 0.0)
    twin.rig._imperfections = replace(twin.rig._imperfections, gain_normal=0.02, bias_normal=0.1)
    with twin.bench:
        weighing = weigh(
            twin.bench, (2.0, 10.0), load=SimulatedOperator(twin.rig),
            prompt=lambda text, normal: None, clock=twin.clock, period=0.01,
        )  # fmt: skip
    check = check_gain(weighing)
    assert check.slope == pytest.approx(1 / 1.02, abs=1e-3)
    assert check.zero == pytest.approx(0.1 / 1.02, abs=2e-3)


def test_no_weight_is_asked_for_while_a_disc_turns(lab):
    class Bystander:
        def request(self, target):
            raise AssertionError(f"asked to hang {target:g} N on a rig that turns")

    twin = lab["twin"]()
    twin.rig.command("leg", 2.0)
    with twin.bench, pytest.raises(RigError, match="leg disc did not come to rest"):
        weigh(
            twin.bench, (2.0,), load=Bystander(), prompt=lambda text, normal: None,
            clock=twin.clock, period=0.01,
        )  # fmt: skip


def test_a_load_cell_that_falls_silent_ends_the_wait_for_the_operator(lab, monkeypatch):
    class Nobody:
        def request(self, target):
            return "hang"

        def follow(self, normal):
            return False

    twin = lab["twin"]()
    read = twin.bench.read

    def unplug(*_):
        monkeypatch.setattr(twin.bench, "read", lambda: replace(read(), normal=np.array([])))

    twin.rig.command("leg", 0.0)
    with twin.bench, pytest.raises(RigTimeout, match=r"no normal force .* within 2 s; .*cable"):
        weigh(twin.bench, (2.0,), load=Nobody(), prompt=unplug, clock=twin.clock, period=0.01)
