# SPDX-License-Identifier: MIT
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.contact.sequence import contact_cycle, contact_states, named_legs
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.thesis.detection import detect_contacts

GAIT = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
PATTERNS = [{0, 3, 4}, {1, 2, 5}, set(), {0, 1, 2, 3, 4, 5}]
DT = 0.01


def contacts(*parts):
    """Return contacts of states that last numbers of samples, with their times."""
    rows = [[leg in legs for leg in range(6)] for legs, count in parts for _ in range(count)]
    return DT * np.arange(len(rows), dtype=float), np.array(rows)


def legs_of(sequence):
    return [set(state.legs) for state in sequence.states]


def test_eq_3_33_with_its_times_is_the_cycle_of_the_tetrapod():
    t = np.arange(9001, dtype=float) * 0.001
    sequence = contact_states(t, detect_contacts(Robot(), GAIT.angles(t)).contact)
    cycle = contact_cycle(sequence, GAIT.period, tolerance=0.01)
    assert cycle is not None
    assert str(cycle) == (
        "{2,5,6} → {2,3,6} (0.41 s) → {1,3,4,6} (0.95 s) → {1,4,5} (1.93 s) → {2,4,5} (2.41 s)"
        " → {2,5,6} (2.93 s)"
    )
    assert cycle.cycles == 3
    assert cycle.settled == pytest.approx(0.414)


@given(st.lists(st.tuples(st.sampled_from(PATTERNS), st.integers(1, 9)), min_size=1, max_size=30),
       st.integers(0, 8))  # fmt: skip
def test_states_cover_the_walk_differ_from_their_neighbours_and_count_what_they_hold(parts, least):
    t, contact = contacts(*parts, ({0}, 9))
    sequence = contact_states(t, contact, least=least * DT)
    states = sequence.states
    assert states[0].start == t[0]
    assert states[-1].end == t[-1]
    for before, after in pairwise(states):
        assert before.end == after.start
        assert before.legs != after.legs
    assert all(state.duration >= least * DT - 1e-9 for state in states)
    assert sequence.joined == sum(state.joined for state in states)


def test_a_step_without_contact_is_joined_to_the_state_that_it_interrupts():
    t, contact = contacts(({0, 3, 4}, 20), ({0, 3}, 1), ({0, 3, 4}, 20), ({1, 2, 5}, 20))
    sequence = contact_states(t, contact, least=0.02)
    assert legs_of(sequence) == [{0, 3, 4}, {1, 2, 5}]
    assert (sequence.joined, sequence.states[0].joined) == (1, 1)
    assert sequence.joined_time == pytest.approx(DT)
    assert legs_of(contact_states(t, contact)) == [{0, 3, 4}, {0, 3}, {0, 3, 4}, {1, 2, 5}]


def test_legs_that_land_some_steps_apart_begin_their_state_with_the_first():
    t, contact = contacts(({0, 3, 4}, 20), ({0, 1, 3, 4}, 1), ({1, 2}, 1), ({1, 2, 5}, 20))
    later = contact_states(t, contact, least=0.02).states[1]
    assert later.start == pytest.approx(0.2)
    assert later.joined == 2


def test_the_transient_is_apart_and_a_cycle_that_changes_is_none():
    cycle = [({0, 3, 4}, 30), ({1, 2, 5}, 20)]
    t, contact = contacts(({0, 1, 2}, 7), ({3, 4, 5}, 3), *cycle * 4)
    found = contact_cycle(contact_states(t, contact), 0.5, tolerance=0.005)
    assert found is not None
    assert found.settled == pytest.approx(0.1)
    assert found.cycles == 4
    assert str(found) == "{2,3,6} → {1,4,5} (0.10 s) → {2,3,6} (0.40 s)"
    t, contact = contacts(*cycle * 3, ({0, 3, 4}, 20), ({1, 2, 5}, 30), ({0, 3, 4}, 9))
    assert contact_cycle(contact_states(t, contact), 0.5, tolerance=0.005) is None
    assert contact_cycle(contact_states(t, contact), 0.5, tolerance=0.15) is not None


def test_legs_that_never_leave_the_ground_have_no_cycle():
    t, contact = contacts(({0, 1, 2, 3, 4, 5}, 100))
    assert contact_cycle(contact_states(t, contact), 0.3, tolerance=0.01) is None


def test_flight_is_the_empty_set():
    assert named_legs(frozenset()) == "{}"
