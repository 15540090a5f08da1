# SPDX-License-Identifier: MIT
"""The journal of an experiment survives what a crash leaves of it."""

import pytest

from zebro_lab.experiment.journal import (
    JOURNAL_FILE,
    JournalWriter,
    begin_or_resume,
    plan_fingerprint,
    read_journal,
)
from zebro_lab.files.errors import AlreadyExists, NotFound, SettingsError


def test_a_journal_survives_a_line_cut_short(tmp_path):
    writer = JournalWriter(tmp_path)
    writer.append("plan", "text", fingerprint="f")
    writer.append("point", "accepted", number=2, accepted=True, folder="a")
    with (tmp_path / JOURNAL_FILE).open("a") as file:
        file.write('{"kind": "point", "number": 3, "acc')
    assert read_journal(tmp_path).accepted == {"a": 2}
    writer.repair()
    writer.append("point", "accepted", number=4, accepted=True, folder="b")
    found = read_journal(tmp_path)
    assert (found.accepted, found.latched) == ({"a": 2, "b": 4}, None)


def begin(folder, *, plan="plan", resume=False, reset=False):
    return begin_or_resume(folder, plan, resume=resume, reset=reset)


def test_an_experiment_is_begun_once_and_resumed_with_its_own_plan(tmp_path):
    assert begin(tmp_path).plan == plan_fingerprint("plan")
    JournalWriter(tmp_path).append("point", "accepted", number=2, accepted=True, folder="a")
    with pytest.raises(AlreadyExists, match="add --resume to continue it"):
        begin(tmp_path)
    with pytest.raises(SettingsError, match="was started with another plan"):
        begin(tmp_path, plan="another", resume=True)
    assert begin(tmp_path, resume=True).accepted == {"a": 2}
    with pytest.raises(NotFound, match="no experiment to resume"):
        begin(tmp_path / "none", resume=True)


def test_an_emergency_stop_stays_until_it_is_reset(tmp_path):
    begin(tmp_path)
    JournalWriter(tmp_path).append("end", "emergency stop: smoke")
    with pytest.raises(SettingsError, match=r"is latched .emergency stop: smoke.; inspect the rig"):
        begin(tmp_path, resume=True)
    assert begin(tmp_path, resume=True, reset=True) == read_journal(tmp_path)
    assert read_journal(tmp_path).latched is None
    with (tmp_path / JOURNAL_FILE).open("a") as file:
        file.write('{"kind": "damaged"}\n')  # by hand, without a text
    assert read_journal(tmp_path).latched is not None
    begin(tmp_path, resume=True, reset=True)
    begin(tmp_path, resume=True)
