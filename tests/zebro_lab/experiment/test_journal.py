# SPDX-License-Identifier: MIT
"""The journal of an experiment survives what a crash leaves of it."""

from zebro_lab.experiment.journal import JOURNAL_FILE, JournalWriter, read_journal


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
