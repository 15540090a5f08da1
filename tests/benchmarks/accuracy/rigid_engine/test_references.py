# SPDX-License-Identifier: MIT
import pytest

from benchmarks.accuracy.rigid_engine import references


@pytest.mark.long
def test_the_engine_walks_as_the_reference_engine_did(one_walk, rows):
    references.main([])
    ((name, path, radius, contacts, kept),) = rows()
    assert name == one_walk
    assert float(path.split()[0]) < 0.2
    assert abs(float(radius.split()[0])) < 0.5
    assert float(contacts.split()[0]) > 99
    assert float(kept.rstrip("°")) < 0.02
