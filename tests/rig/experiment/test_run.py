# SPDX-License-Identifier: MIT
"""A plan is run on a twin: order of points, repeats, stops and what is kept."""

from dataclasses import replace

import numpy as np
import pytest

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.errors import DeviceFault, LimitExceeded, ProtocolError, RigTimeout
from rig.experiment.condition import RigState
from rig.experiment.load import HandShaft
from rig.experiment.sink import ExperimentWatcher, SinkFailed
from rig.safety import StopCategory
from rig.slip_rig.decode import Zero, measured_slip
from support.memory_sink import MemorySink


def reasons(sink):
    return [text for kind, text in sink.events if kind == "end"]


def test_a_plan_runs_to_its_end_and_every_point_obeys_the_law(lab):
    twin = lab["twin"]()
    outcome = twin.run()
    assert outcome.completed
    assert (outcome.finished, outcome.refused) == (6, ())
    assert twin.at_rest()
    assert reasons(twin.sink) == ["completed"]
    for run in twin.sink.accepted:
        slip = measured_slip(run.readings.omega_leg, run.readings.omega_ground, twin.bench.profile)
        expected = THESIS_LAW.force(slip, run.readings.normal_force, THESIS_VALUES)
        assert run.readings.traction_force.mean() == pytest.approx(expected.mean(), abs=0.25)
        assert np.all(np.diff(run.readings.t) > 0)


def test_a_sweep_glides_through_its_slips(lab):
    twin = lab["twin"]()
    wanted = lab["plan"](points={"sweep": True, "duration": 4.0}, accept={"slip": 0.05})
    assert twin.run(wanted).completed
    run = twin.sink.accepted[0]
    slip = measured_slip(run.readings.omega_leg, run.readings.omega_ground, twin.bench.profile)
    at = (run.readings.t - run.readings.t[0]) / np.ptp(run.readings.t)
    commanded = np.array([run.start.point.slip_at(f) for f in at])
    assert np.abs(slip - commanded).mean() < 0.03


def test_a_point_that_cannot_be_good_is_tried_again_and_then_refused(lab):
    twin = lab["twin"]()
    outcome = twin.run(lab["plan"](accept={"slip": 1e-9, "attempts": 2}))
    assert outcome.completed
    assert len(outcome.refused) == 6
    assert outcome.attempts == 12
    assert not twin.sink.accepted
    assert "off its set-point" in twin.sink.runs[0].verdict.problems[0]


def test_a_rig_that_never_settles_says_so(lab):
    twin = lab["twin"]()
    wanted = lab["plan"](
        settle={"friction": 1e-12, "timeout": 0.4}, accept={"attempts": 1}, points={"loads": [4.0]}
    )
    outcome = twin.run(wanted)
    assert len(outcome.refused) == 3
    assert "the rig was not steady within settle.timeout" in twin.sink.runs[0].verdict.problems


def test_a_resumed_run_measures_only_what_is_left_after_a_new_zero(lab):
    twin = lab["twin"]()
    twin.sink = lab["At"](60, lambda: twin.control.stop.request(StopCategory.SAFE, "planted"))
    first = twin.run()
    assert first.reason == "safe stop: planted"
    done = {run.start.point.number for run in twin.sink.accepted}
    assert 0 < len(done) < 6
    again = lab["twin"](seed=1)
    outcome = again.run(done=done)
    assert outcome.finished == 6
    assert {r.start.point.number for r in again.sink.accepted} | done == set(range(2, 8))
    assert not {r.start.point.number for r in again.sink.accepted} & done
    assert [kind for kind, _ in again.sink.events if kind == "zero"] == ["zero"]


def test_a_force_beyond_its_limit_stops_within_so_many_samples(lab):
    twin = lab["twin"]()

    def overload():
        twin.rig.load = 40.0

    twin.sink = lab["At"](10, overload)
    with pytest.raises(LimitExceeded, match=r"normal force is .* N; its limit is 25 N"):
        twin.run()
    assert twin.at_rest()
    assert reasons(twin.sink)[0].startswith("LimitExceeded: normal force")
    assert twin.sink.runs[-1].verdict is None
    again = lab["twin"](seed=1)
    assert again.run(done={r.start.point.number for r in twin.sink.accepted}).finished == 6


def silence(twin, monkeypatch):
    monkeypatch.setattr(twin.board, "_frames", lambda due: [])


def no_room(twin, monkeypatch):
    twin.sink.room = 0.0


def held_up(twin, monkeypatch):
    twin.clock.sleep(0.5)  # beyond the watchdog


def broken(twin, monkeypatch):
    raise ZeroDivisionError("planted")


def ground_disc_stays(twin, monkeypatch):
    command = twin.rig.command
    monkeypatch.setattr(
        twin.rig, "command", lambda disc, omega: command(disc, omega if disc == "leg" else 0.0)
    )


FAULTS = {
    "traction": (
        lambda *_: None, {"traction_force": 1.0}, LimitExceeded,
        r"traction force is .* N; its limit is 1 N"),
    "silent device": (silence, {}, RigTimeout, "stream 'board' sent nothing within"),
    "stopped by itself": (held_up, {}, (DeviceFault, RigTimeout), "board|watchdog"),
    "disc that does not follow": (
        ground_disc_stays, {"speed_error": 2.0}, LimitExceeded,
        "speed error of the ground disc at its set-point"),
    "full disk": (no_room, {}, SinkFailed, "room left is 0 bytes"),
    "any exception": (broken, {}, ZeroDivisionError, "planted"),
}  # fmt: skip


@pytest.mark.parametrize(("plant", "limits", "error", "message"), FAULTS.values(), ids=FAULTS)
def test_any_fault_leaves_the_discs_at_rest_and_is_the_reason(
    lab, monkeypatch, plant, limits, error, message
):
    twin = lab["twin"]()
    twin.sink = lab["At"](10, lambda: plant(twin, monkeypatch))
    with pytest.raises(error, match=message) as raised:
        twin.run(lab["plan"](limits=limits))
    assert twin.at_rest()
    assert reasons(twin.sink) == [f"{type(raised.value).__name__}: {raised.value}"]


@pytest.mark.parametrize("category", [None, StopCategory.SAFE, StopCategory.EMERGENCY])
def test_an_end_that_cannot_be_stored_is_an_error_however_the_run_ended(lab, category):
    class WithoutEnd(lab["At"]):
        def event(self, kind, text):
            if kind == "end":
                raise SinkFailed("no room for the end")
            super().event(kind, text)

    class Screen(ExperimentWatcher):
        def changed(self, condition):
            shown.append(condition.state)

    twin, shown = lab["twin"](), []
    twin.sink = WithoutEnd(10, lambda: category and twin.control.stop.request(category, "planted"))
    with pytest.raises(SinkFailed, match="no room for the end"):
        twin.run(watcher=Screen())
    assert twin.at_rest()
    latched = category is StopCategory.EMERGENCY
    assert shown[-1] is (RigState.LATCHED if latched else RigState.STOPPED)


def test_a_host_that_hangs_is_stopped_by_the_watchdog(lab):
    twin = lab["twin"]()

    def hang():
        twin.board.poll(twin.clock.now() + 0.3, b"")
        twin.rig.advance(twin.clock.now() + 0.9)
        assert all(abs(omega) < 0.1 for _, omega in twin.rig.speeds().values())
        raise TimeoutError

    twin.sink = lab["At"](10, hang)
    with pytest.raises(TimeoutError):
        twin.run()


def test_a_soft_stop_holds_and_the_point_is_done_anew(lab):
    twin = lab["twin"]()
    twin.sink = lab["At"](10, lambda: twin.control.stop.request(StopCategory.SOFT, "planted"))
    speeds = []

    sleep = twin.clock.sleep
    held = []

    def passing(duration):
        sleep(duration)
        if twin.control.status.startswith(
            "HOLDING, discs energised: soft stop: planted; r + Enter: resume"
        ):
            held.append(twin.clock.now())
            if twin.clock.now() - held[0] > 2.0:
                speeds.append(twin.rig.speeds()["leg"][1])
                twin.control.resume()

    twin.clock.sleep = passing
    outcome = twin.run()
    assert outcome.completed
    assert outcome.finished == 6
    assert abs(speeds[0]) < 0.1
    assert twin.sink.runs[0].reason == "soft stop: planted"
    assert [kind for kind, _ in twin.sink.events].count("go on") == 1


def test_a_soft_stop_without_a_word_becomes_a_safe_one(lab):
    twin = lab["twin"]()
    twin.sink = lab["At"](10, lambda: twin.control.stop.request(StopCategory.SOFT, "planted"))
    outcome = twin.run()
    assert outcome.reason.startswith("safe stop: held for 5 s and not resumed")
    assert twin.at_rest()


def test_a_pause_waits_for_the_end_of_the_point(lab):
    twin = lab["twin"]()
    twin.sink = lab["At"](10, twin.control.pause)
    outcome = twin.run()
    assert "safe stop" in outcome.reason  # nobody resumed
    assert [run.reason for run in twin.sink.runs] == ["completed"]


def test_an_emergency_stop_is_at_once_and_latched_until_it_is_reset(lab):
    twin = lab["twin"]()
    at = []

    def push():
        twin.control.stop.request(StopCategory.EMERGENCY, "planted")
        at.append(twin.clock.now())

    twin.sink = lab["At"](10, push)
    outcome = twin.run()
    assert outcome.reason == "emergency stop: planted"
    assert twin.clock.now() - at[0] < 0.05  # no ramp
    assert twin.at_rest()
    twin.control.resume()
    with pytest.raises(ProtocolError, match="latched"):
        twin.run()
    twin.control.stop.reset()
    twin.sink = MemorySink()
    assert twin.run().completed


def test_a_harder_stop_cuts_a_ramp_short(lab):
    twin = lab["twin"]()
    twin.sink = lab["At"](10, lambda: twin.control.stop.request(StopCategory.SAFE, "first"))
    sleep, began = twin.clock.sleep, []

    def passing(duration):
        sleep(duration)
        if twin.control.stop.pending and not began:
            began.append(twin.clock.now())
        if began and twin.clock.now() - began[0] > 0.05:
            twin.control.stop.request(StopCategory.EMERGENCY, "second")

    twin.clock.sleep = passing
    twin.run()
    assert twin.clock.now() - began[0] < 0.15  # the ramp alone takes 0.3 s
    assert twin.at_rest()


def test_guards_that_are_off_are_kept_in_the_log_and_shown(lab):
    twin = lab["twin"]()
    shown = []

    class Screen(ExperimentWatcher):
        def doing(self, what, *, done, of, left):
            shown.append(what)

        def judged(self, point, verdict, *, attempt):
            pass

    limits = {"silence": 1.5, "guards_off": ["silence"]}
    assert twin.run(lab["plan"](limits=limits), watcher=Screen()).completed
    assert ("guards off", "silence (1.5 s)") in twin.sink.events[:2]
    assert all(what.endswith("[guards off: silence]") for what in shown)


class Shaft(ExperimentWatcher):
    """A person at the shaft who confirms with 4 N left on the cell, until the question is asked."""

    def __init__(self, twin):
        self.twin, self.asked, self.notices = twin, [], []

    def prompt(self, text, *, normal):
        if text not in self.asked:
            self.asked.append(text)
            first = len(self.asked) == 1
            load = float(text.split()[5]) if text.startswith("set") else 4.0 if first else 1e-3
            self.twin.rig.load = load
        self.twin.control.confirm()

    def notice(self, text):
        self.notices.append(text)

    @property
    def questions(self):
        return [text for text in self.asked if "is it unloaded?" in text]

    def judged(self, point, verdict, *, attempt):
        pass


def by_hand(twin, **options):
    shaft = Shaft(twin)
    hand = HandShaft(twin.control, tolerance=8.0)  # the discs may stand on the bump
    return shaft, twin.run(load=hand, watcher=shaft, **options)


KNOWN = Zero(0.0, 0.0, 0.2)


@pytest.mark.parametrize("known", ["nothing", "profile", "earlier zero"])
def test_a_zero_under_load_is_asked_about_and_taken_again(lab, known):
    twin = lab["twin"]()
    if known == "profile":
        twin.bench.profile = replace(twin.bench.profile, unloaded=KNOWN)
    zero = Zero(0.0, 0.0, 0.02) if known == "earlier zero" else None
    shaft, outcome = by_hand(twin, zero=zero)
    assert outcome.completed
    assert "reads 4." in shaft.questions[0]
    # Without anything known, what it reads unloaded is asked about, too.
    assert len(shaft.questions) == (2 if known == "nothing" else 1)
    for run in twin.sink.accepted:
        assert abs(run.start.zero.normal) < 0.1
        assert abs(run.start.zero.traction) < 0.2


def test_a_known_unloaded_cell_is_not_asked_about(lab):
    twin = lab["twin"]()
    twin.bench.profile = replace(twin.bench.profile, unloaded=KNOWN)
    questions = []

    class Careful(Shaft):
        def prompt(self, text, *, normal):
            if "is it unloaded?" in text:
                questions.append(text)
            twin.rig.load = float(text.split()[5]) if text.startswith("set") else 1e-3
            twin.control.confirm()

    assert twin.run(load=HandShaft(twin.control, tolerance=8.0), watcher=Careful(twin)).completed
    assert not questions


def test_points_that_contradict_each_other_are_named_on_screen_and_in_the_log(lab):
    twin, notices, loaded = lab["twin"](), [], 4.0

    class Careless(ExperimentWatcher):
        def prompt(self, text, *, normal):
            wanted = float(text.split()[5]) if text.startswith("set") else 0.0
            twin.rig.load = loaded + wanted  # a load is left on at the zero, and asked about
            twin.control.confirm()

        def notice(self, text):
            notices.append(text)

    plan = lab["plan"](points={"loads": [2.0, 8.0]})
    load = HandShaft(twin.control, tolerance=8.0)
    assert twin.run(plan, load=load, watcher=Careless()).completed
    warnings = [text for kind, text in twin.sink.events if kind == "warning"]
    assert warnings == notices != []
    assert all("Fn 2 N slip" in text and "Fn 8 N slip" in text for text in warnings)
    assert all("check the zero" in text for text in warnings)
    notices.clear()
    loaded = 0.0
    assert lab["twin"]().run(plan, watcher=Careless()).completed  # a sound rig
    assert not notices
