# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import DeviceFault, LimitExceeded, ProfileError, ProtocolError
from rig.links.faults import Faults
from rig.links.memory import MemoryLink
from rig.profile import shipped_file
from rig.slip_rig.board import RigBoard
from rig.slip_rig.decode import decode_board
from rig.slip_rig.imperfections import TYPICAL_RIG, RigImperfections
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import TWIN_LAWS, RigDynamics, simulated_rig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan

PROFILE = load_rig_profile("rig-board-serial")
PERFECT = RigImperfections()


def world(law="magic-formula", *, plan=None, imperfections=PERFECT, dynamics=None, seed=0):
    return simulated_rig(
        law,
        plan=plan or SweepPlan(),
        imperfections=imperfections,
        dynamics=dynamics or RigDynamics(),
        rng=np.random.default_rng(seed),
    )


def board(rig, **options):
    clock = ManualClock()
    twin = SimulatedBoard(rig, profile=PROFILE.board, rng=np.random.default_rng(0), **options)
    stream = RigBoard(
        MemoryLink(twin, clock=clock), profile=PROFILE.board, limits=PROFILE.limits, clock=clock
    )
    return stream, clock


@pytest.mark.parametrize("law", TWIN_LAWS)
def test_a_rig_left_alone_glides_through_its_slips_and_obeys_its_law(law):
    plan = SweepPlan(slips=(0.0, 0.02, 0.1, 0.5), loads=(8.0,), duration=2.0)
    rig = world(law, plan=plan)
    chosen, values = TWIN_LAWS[law]
    for hundredth in range(600):
        rig.advance(hundredth / 100)
        if hundredth in (200, 400):
            truth = rig.truth()
            np.testing.assert_allclose(
                truth.traction, chosen.force(truth.slip, truth.load, values), atol=1e-12
            )
    truth = rig.truth(4.0)
    late = RigDynamics().speed_lag
    at = np.interp([4.5 + late, 5.0 + late, 5.5 + late], truth.time, truth.slip)
    np.testing.assert_allclose(at, [0.2, 0.3, 0.4], atol=3e-3)


def test_a_rig_left_alone_takes_one_load_after_another():
    rig = world(plan=SweepPlan(slips=(0.0, 0.5), loads=(2.0, 6.0), duration=0.5))
    since_start, loads = np.arange(30) / 10, []
    for time in since_start:
        rig.advance(0.05 + time)
        loads.append(rig.load)
    expected = np.where(since_start % 2.0 < 1.0, 2.0, 6.0)
    assert np.mean(np.array(loads) == expected) > 0.9


def test_the_same_seed_gives_the_same_rig_however_often_it_is_asked():
    def run(step):
        rig = world(imperfections=PERFECT, seed=4)
        rig.command("leg", 10.0)
        rig.command("ground", 2.0)
        rig.advance(0.0)
        for k in range(1, round(0.5 / step) + 1):
            rig.advance(k * step)
        return rig.truth()

    fine, coarse = run(0.005), run(0.05)
    np.testing.assert_allclose(fine.traction, coarse.traction, atol=1e-9)


def test_the_bump_raises_the_load_and_ripple_the_speed():
    rig = world(imperfections=TYPICAL_RIG, dynamics=RigDynamics(ripple=0.02))
    rig.advance(0.0)
    rig.command("leg", 12.0)
    rig.command("ground", 3.0)
    rig.advance(4.0)
    truth = rig.truth()
    assert truth.load.max() == pytest.approx(rig.load * 1.6, rel=1e-3)
    late = truth.omega_leg[-7000:]
    assert np.ptp(late) == pytest.approx(2 * 0.02 * 12.0, rel=0.05)


def test_a_delay_shows_the_force_of_before():
    rig = world(imperfections=TYPICAL_RIG, dynamics=RigDynamics(force_delay=0.1))
    rig.advance(0.0)
    rig.advance(1.0)
    _, late = rig.forces(np.array([0.9]))
    truth = rig.truth()
    assert late[0] == truth.traction[np.searchsorted(truth.time, 0.8 + 1e-5) - 1]


def test_a_standing_leg_disc_carries_no_force():
    rig = world()
    rig.command("leg", 0.0)
    rig.command("ground", 5.0)
    rig.advance(0.0)
    rig.advance(0.5)
    assert np.all(rig.truth().traction == 0)


def test_what_is_true_of_a_rig_can_be_written_down():
    said = world("brush", imperfections=TYPICAL_RIG).description()
    assert said["law"] == "brush"
    assert said["imperfections"]["bump_height"] == TYPICAL_RIG.bump_height


def test_an_unknown_law_and_impossible_dynamics_are_refused():
    with pytest.raises(ProtocolError, match="known: magic-formula"):
        world("ice")
    with pytest.raises(ProtocolError, match="speed_lag is 0 s"):
        RigDynamics(speed_lag=0.0)
    with pytest.raises(ProtocolError, match="not run yet"):
        world().truth()


def test_a_board_turns_and_weighs():
    stream, clock = board(world())
    with stream:
        stream.leg.arm(1.0)
        stream.ground.arm(1.0)
        stream.leg.set_speed(12.0)
        stream.ground.set_speed(3.0)
        samples = list(iterate(stream, duration=1.0, clock=clock))
    forces, speeds = decode_board(PROFILE.board, samples)
    assert speeds.leg[-1] == pytest.approx(12.0, rel=1e-3)
    assert speeds.ground[-1] == pytest.approx(3.0, rel=1e-3)
    law, values = TWIN_LAWS["magic-formula"]
    expected = law.force(speeds.slip(PROFILE)[-1], forces.normal[-1], values)
    assert forces.traction[-1] == pytest.approx(float(expected), rel=1e-2)


def test_a_board_that_hears_nothing_stops_and_stays_stopped_until_it_is_armed_again():
    rig = world()
    stream, clock = board(rig)
    with stream:
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=1.0, clock=clock))
        stream.require_healthy()
        assert rig.speeds()["leg"][1] > 11
        clock.sleep(0.5)  # the host is held up, and comes back
        list(iterate(stream, duration=0.5, clock=clock))
        assert abs(rig.speeds()["leg"][1]) < 0.01
        with pytest.raises(DeviceFault, match="watchdog"):
            stream.require_healthy()
        stream.leg.disarm()
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=0.5, clock=clock))
        stream.require_healthy()
        assert rig.speeds()["leg"][1] > 11


def test_leaving_a_board_stops_the_discs():
    rig = world()
    stream, clock = board(rig)
    with stream:
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=0.5, clock=clock))
    rig.advance(clock.now() + 0.5)
    assert abs(rig.speeds()["leg"][1]) < 0.01


def test_a_board_on_a_bad_line_hands_on_nothing_wrong():
    stream, clock = board(world(), faults=Faults(flip=1e-3, drop=0.02, duplicate=0.02, delay=0.02))
    with stream:
        samples = list(iterate(stream, duration=5.0, clock=clock))
    numbers = [sample.sequence for sample in samples]
    counters = stream.counters
    assert counters.received + counters.lost == numbers[-1] - numbers[0] + 1
    assert counters.damaged > 100
    limit = 25.0 * PROFILE.board.counts_per_force
    assert all(abs(sample.counts[0]) < limit for sample in samples)


def test_a_board_refuses_a_speed_beyond_the_limit():
    stream, _ = board(world())
    with stream, pytest.raises(LimitExceeded, match="ground disc is 99 rad/s"):
        stream.ground.set_speed(99.0)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[board]", "[load_cell]", r"either \[drives\] and \[load_cell\], or \[board\]"),
        ("radius_leg = 0.035", "radius_leg = 0", "radius_leg: found 0; expected a number above 0"),
        ("normal_sign = 1", "normal_sign = 0", "1 or -1"),
        ("rate = 1000.0", "rates = 1000.0", "rate: is missing"),
        ("speed = 40.0", "speed = 40.0\nspeeed = 1", "did you mean 'speed'"),
    ],
)
def test_a_malformed_rig_profile_is_refused_and_the_place_named(tmp_path, old, new, said):
    text = shipped_file("rig-board-serial.toml").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(ProfileError, match=said):
        load_rig_profile(str(path))


def test_two_drives_on_one_node_are_refused(tmp_path):
    text = shipped_file("rig-odrive-netft.toml").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(text.replace("node = 1", "node = 0"))
    with pytest.raises(ProfileError, match="both drives have node 0"):
        load_rig_profile(str(path))
