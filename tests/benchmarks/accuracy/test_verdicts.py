# SPDX-License-Identifier: MIT
"""Verdicts on sound, thin and wrong data."""

import numpy as np
import pytest

from benchmarks.accuracy import verdicts
from benchmarks.accuracy.verdicts import CURES, THIN, WRONG, cured, is_named, judged, sound
from model.bayes.verdict import State


def quick(data):
    """Judge data at once where the first run, which brakes, has the sign that it should have."""
    if data.traction[0] < 0:
        return verdicts.Judged("sound", State.TRUSTWORTHY)
    return judged(data)


GOOD = (State.TRUSTWORTHY, State.AS_TESTED)


def test_faults_are_made_and_refused_data_are_told(monkeypatch, rows):
    monkeypatch.setattr(verdicts, "BOTH", verdicts.BOTH[:16])
    monkeypatch.setattr(verdicts, "THIN", {})
    monkeypatch.setattr(verdicts, "CURES", {})
    turned = verdicts.Way(verdicts.wrong_sign, (1.0, 1.0, 1.0), ("opposes",))
    monkeypatch.setattr(verdicts, "WRONG", {"sign": turned})
    monkeypatch.setattr(verdicts, "judged", quick)
    verdicts.main(["1"])
    found = rows()
    assert [row[:5] for row in found] == [["sign", "1", "inf", "0 of 1", "1 of 1"]] * 3
    assert all("opposes the slip in 100% of the rows" in row[5] for row in found)


@pytest.mark.parametrize("name", WRONG)
def test_every_fault_changes_the_table_or_its_map(name):
    data = sound(0, verdicts.BOTH[:16])
    changed = WRONG[name].make(data, WRONG[name].sizes[2], 0)
    assert changed.columns != data.columns or not changed.table.equals(data.table)
    assert np.isfinite(changed.traction).all()


@pytest.mark.long
@pytest.mark.parametrize("name", THIN)
def test_thin_data_are_trusted_as_far_as_they_were_tested(name):
    found = [judged(THIN[name](seed)) for seed in range(3)]
    assert [each.state for each in found] == [State.AS_TESTED] * 3
    assert all("untested: " in each.said for each in found)


@pytest.mark.long
@pytest.mark.parametrize("name", WRONG)
def test_wrong_data_are_not_trusted_and_their_fault_is_named(name):
    way = WRONG[name]
    found = [judged(way.make(sound(seed), way.sizes[2], seed)) for seed in range(3)]
    assert not any(each.state in GOOD for each in found)
    assert all(is_named(each, way) for each in found)


@pytest.mark.long
@pytest.mark.parametrize("slips", [verdicts.BOTH, verdicts.DRIVING], ids=["two-sided", "one-sided"])
def test_sound_data_raise_hardly_any_alarm(slips):
    states = [judged(sound(seed, slips)).state for seed in range(20)]
    assert sum(state not in GOOD for state in states) <= 2  # with 1 in 20, more in 8 of 100 trials


@pytest.mark.long
@pytest.mark.parametrize("name", CURES)
def test_following_the_advice_mends_the_fault(name):
    before, after = cured(name, 1)
    assert before.state is State.NOT_TRUSTWORTHY
    assert after.state in GOOD, after.said
