# SPDX-License-Identifier: MIT
"""An emergency stop stays latched, whatever happens beside it."""

import os
from pathlib import Path

import pytest

from rig.errors import RigError
from rig.experiment.control import Control
from rig.experiment.guards import RigGuards
from rig.safety import StopCategory
from zebro_lab.experiment.journal import JOURNAL_FILE, JournalWriter
from zebro_lab.experiment.latch import LATCH_FILE, EmergencyLatch
from zebro_lab.files.errors import NotFound, SettingsError, ZebroLabError


@pytest.fixture(name="plan")
def _plan(plan):
    """Return a plan of three points, after two of which is stopped."""
    plan.write_text(plan.read_text().replace("loads = [4.0, 8.0]", "loads = [8.0]"))
    return plan


def stop_by_emergency(lab, plan, data, reason="planted", action=lambda: None):
    control = Control()

    def push():
        control.stop.request(StopCategory.EMERGENCY, reason)
        action()

    return lab.run(plan, data, watcher=lab.StopAfter(2, push), control=control)


def require_latched(lab, plan, data):
    with pytest.raises(SettingsError, match="latched"):
        lab.run(plan, data, resume=True)
    assert lab.run(plan, data, resume=True, reset_emergency=True).completed
    assert lab.run(plan, data, resume=True).attempts == 0


@pytest.mark.parametrize("separator", ["\u2028", "\u2029", "\x85"])
def test_a_line_separator_in_the_reason_releases_nothing(lab, plan, tmp_path, separator):
    data = tmp_path / "data"
    stop_by_emergency(lab, plan, data, reason=f"smoke{separator}fire")
    require_latched(lab, plan, data)


def test_an_emergency_beside_a_guard_is_latched(lab, plan, tmp_path, monkeypatch):
    plan.write_text(plan.read_text().replace("traction_force = 15.0", "traction_force = 0.6"))
    data, control, guard = tmp_path / "data", Control(), RigGuards.check

    def trip(self, batch, **state):
        try:
            guard(self, batch, **state)
        except RigError:  # the operator sees it in the same moment
            control.stop.request(StopCategory.EMERGENCY, "planted")
            raise

    monkeypatch.setattr(RigGuards, "check", trip)
    with pytest.raises(RigError, match="traction force"):
        lab.run(plan, data, control=control)
    with pytest.raises(SettingsError, match="latched"):
        lab.run(plan, data, resume=True)


def test_an_emergency_on_a_full_disk_is_latched(lab, plan, tmp_path, monkeypatch):
    def full(self, kind, text, **more):
        raise OSError(28, "No space left on device")

    data = tmp_path / "data"
    with pytest.raises(OSError, match="No space left"):
        stop_by_emergency(
            lab, plan, data, action=lambda: monkeypatch.setattr(JournalWriter, "append", full)
        )
    monkeypatch.undo()
    require_latched(lab, plan, data)


@pytest.mark.parametrize(
    "damage", [b'{"kind": "e\xff\xfe"}\n', b"\x00\x00\x00\n", b"[1]\n", b'{"kind": "end", "te\n']
)
def test_a_journal_with_a_damaged_line_counts_as_latched(lab, plan, tmp_path, damage):
    data, control = tmp_path / "data", Control()
    stop = lab.StopAfter(2, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    lab.run(plan, data, watcher=stop, control=control)
    with (data / JOURNAL_FILE).open("ab") as file:
        file.write(damage + b'{"kind": "note", "text": "after it"}\n')
    require_latched(lab, plan, data)


@pytest.mark.parametrize("resume", [False, True])
def test_a_latch_without_its_journal_is_latched(lab, plan, tmp_path, resume):
    data = tmp_path / "data"
    data.mkdir()
    EmergencyLatch(data).prepare()
    EmergencyLatch(data).latch("emergency stop: smoke")
    with pytest.raises((SettingsError, NotFound), match=r"latched|no experiment"):
        lab.run(plan, data, resume=resume)
    assert EmergencyLatch(data).reason == "emergency stop: smoke"
    if not resume:
        assert lab.run(plan, data, reset_emergency=True).completed
        assert EmergencyLatch(data).reason is None


@pytest.mark.parametrize("name", ["emergency-latch", ".experiment.reserve", JOURNAL_FILE])
@pytest.mark.parametrize("kind", ["fifo", "folder", "link"])
@pytest.mark.timeout(60)
def test_what_is_no_file_in_the_place_of_one_holds_nothing_up(lab, plan, tmp_path, name, kind):
    data, victim = tmp_path / "data", tmp_path / "victim"
    data.mkdir()
    victim.write_text("precious")
    place = data / name
    make = {"fifo": os.mkfifo, "folder": Path.mkdir, "link": lambda p: p.symlink_to(victim)}
    make[kind](place)
    if name == ".experiment.reserve":
        assert lab.run(plan, data).completed
    else:
        with pytest.raises(ZebroLabError) as raised:
            lab.run(plan, data)
        assert "\n" not in str(raised.value)
        with pytest.raises(ZebroLabError):
            lab.run(plan, data, resume=True)
    assert victim.read_text() == "precious"


def test_a_latch_that_turned_into_a_fifo_holds_no_stop_up(tmp_path):
    latch = EmergencyLatch(tmp_path)
    latch.prepare()
    (tmp_path / LATCH_FILE).unlink()
    os.mkfifo(tmp_path / LATCH_FILE)
    with pytest.raises(OSError, match="emergency-latch"):
        latch.latch("emergency stop: smoke")
    assert "regular" in latch.reason
