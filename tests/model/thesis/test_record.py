# SPDX-License-Identifier: MIT
"""A row of the record holds the step that was kept, and nothing of legs without load."""

import numpy as np

from model.thesis.kinematics import Legs
from model.thesis.loads import Balance
from model.thesis.record import empty_record, keep_contacts, keep_legs


def test_a_row_keeps_all_legs_and_the_three_that_carry_load():
    rng, record, three = np.random.default_rng(1), empty_record(2), np.array([0, 3, 4])
    legs = Legs(*rng.normal(size=(5, 6)), *rng.normal(size=(2, 6, 3)))
    balance = Balance(*rng.normal(size=(2, 3, 3)), rng.normal(size=(3, 2)), np.ones(2), np.ones(2),
                      rng.normal(size=(3, 3)))  # fmt: skip
    static, loads, forces = rng.normal(size=3), rng.normal(size=3), rng.normal(size=(3, 2))
    keep_legs(record, 1, legs)
    keep_contacts(record, 1, three, balance, static, loads, forces)
    np.testing.assert_array_equal(record.phi[1], legs.phi)
    np.testing.assert_array_equal(record.height[1], legs.height)
    np.testing.assert_array_equal(np.flatnonzero(record.contact[1]), three)
    np.testing.assert_array_equal(record.kappa[1, three], balance.slip[:, 0])
    np.testing.assert_array_equal(record.normal[1, three], loads)
    np.testing.assert_array_equal(record.static[1, three], static)
    np.testing.assert_array_equal(record.left[1, three], forces[:, 1])
    np.testing.assert_array_equal(record.speeds[1, three], balance.speeds)
    others = [1, 2, 5]
    assert np.isnan(record.kappa[1, others]).all()
    assert not record.normal[1, others].any()
    assert not record.contact[0].any()
