# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples

LENGTHS = st.lists(st.integers(1, 20), min_size=1, max_size=6)


def samples(lengths):
    n = sum(lengths)
    slip = np.linspace(-0.5, 0.8, n)
    return SlipSamples(
        slip=slip,
        normal_force=5 + slip,
        traction_force=2 * slip,
        run=np.repeat(np.arange(len(lengths)), lengths),
        run_names=tuple(f"run {index}" for index in range(len(lengths))),
        definition=SlipDefinition.MATERIAL,
        time=np.arange(n) / 100,
    )


@given(LENGTHS)
def test_slices_cut_the_record_into_its_runs(lengths):
    data = samples(lengths)
    parts = data.slices()
    assert [part.stop - part.start for part in parts] == lengths
    for index, part in enumerate(parts):
        np.testing.assert_array_equal(data.run[part], index)
    assert sum(part.stop - part.start for part in parts) == len(data)
