# SPDX-License-Identifier: MIT
from benchmarks.speed import guard_reaction


def test_every_trip_of_both_rigs_is_timed(monkeypatch, rows):
    monkeypatch.setattr(guard_reaction, "TRIPS", 2)
    guard_reaction.main()
    table = rows()
    assert [row[2] for row in table] == ["2"] * 4
    assert all(0 <= float(median) <= float(late) for *_, median, late in table)
