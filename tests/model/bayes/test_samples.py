# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.bayes.samples import SlipSamples
from model.slip import SlipDefinition, convert_slip

LENGTHS = st.lists(st.integers(1, 20), min_size=1, max_size=6)


def samples(lengths=(3, 5, 2), *, time=True):
    n = sum(lengths)
    slip = np.linspace(-0.5, 0.8, n)
    return SlipSamples(
        slip=slip,
        normal_force=5 + slip,
        traction_force=2 * slip,
        run=np.repeat(np.arange(len(lengths)), lengths),
        run_names=tuple(f"run {index}" for index in range(len(lengths))),
        definition=SlipDefinition.MATERIAL,
        time=np.arange(n) / 100 if time else None,
    )


@given(LENGTHS)
def test_slices_cut_the_record_into_its_runs(lengths):
    data = samples(lengths)
    parts = data.slices()
    assert [part.stop - part.start for part in parts] == lengths
    for index, part in enumerate(parts):
        np.testing.assert_array_equal(data.run[part], index)
    assert sum(part.stop - part.start for part in parts) == len(data)


@given(lengths=LENGTHS, seed=st.integers(0, 50))
def test_chosen_runs_keep_their_samples_names_and_order(lengths, seed):
    keep = np.random.default_rng(seed).random(len(lengths)) < 0.5
    keep[seed % len(lengths)] = True
    data = samples(lengths)
    chosen = data.only_runs(keep)
    rows = keep[data.run]
    for name in ("slip", "normal_force", "traction_force", "time"):
        np.testing.assert_array_equal(getattr(chosen, name), getattr(data, name)[rows])
    assert chosen.run_names == tuple(np.array(data.run_names)[keep])
    assert [part.stop - part.start for part in chosen.slices()] == list(np.array(lengths)[keep])


def test_all_runs_chosen_are_the_samples_themselves():
    data = samples()
    chosen = data.only_runs(np.ones(data.n_runs, dtype=bool))
    for name in ("slip", "normal_force", "traction_force", "run", "time"):
        np.testing.assert_array_equal(getattr(chosen, name), getattr(data, name))
    assert (chosen.run_names, chosen.definition) == (data.run_names, data.definition)


@pytest.mark.parametrize("definition", list(SlipDefinition))
def test_another_definition_changes_slip_alone_and_back_again(definition):
    data = samples()
    other = data.with_definition(definition)
    assert other.definition is definition
    np.testing.assert_allclose(other.slip, convert_slip(data.slip, data.definition, definition))
    for name in ("normal_force", "traction_force", "run", "time"):
        np.testing.assert_array_equal(getattr(other, name), getattr(data, name))
    np.testing.assert_allclose(other.with_definition(data.definition).slip, data.slip)


def test_a_definition_may_be_given_by_its_name():
    name = SlipDefinition.TRAVEL.value
    assert samples().with_definition(name).definition is SlipDefinition.TRAVEL


def test_the_sample_interval_is_taken_within_runs():
    data = samples((3, 3))
    gap = np.where(data.run == 1, 100.0, 0.0)
    apart = SlipSamples(**{**vars(data), "time": data.time + gap})
    assert apart.sample_interval() == pytest.approx(0.01)


def test_without_time_there_is_no_sample_interval():
    assert samples(time=False).sample_interval() is None
    assert samples(time=False).only_runs(np.array([True, False, True])).time is None


def test_runs_of_one_sample_have_no_interval():
    assert samples((1, 1, 1)).sample_interval() is None
