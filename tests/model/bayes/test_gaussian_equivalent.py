# SPDX-License-Identifier: MIT
"""Checks of a fit with Student-t noise see the blocks that Gaussian noise would have left."""

from dataclasses import replace

import numpy as np

from model.bayes.gaussian_equivalent import gaussian_equivalent
from model.bayes.likelihood import predict_blocks
from support.dropped_forces import KNOWN, LAW, posterior_of, simulated


def test_far_blocks_come_near_and_the_others_stay_for_the_checks():
    posterior = posterior_of(simulated(1, 0.05))
    values = posterior.values(posterior.coordinates(KNOWN)[None])
    assert gaussian_equivalent(posterior, values) is posterior
    blocks = gaussian_equivalent(replace(posterior, tail=3.0), values).blocks
    expected = predict_blocks(blocks, LAW, values).force[0]
    before = np.abs(posterior.blocks.traction_force - expected)
    after = np.abs(blocks.traction_force - expected)
    far = before > 0.8
    assert far.sum() > 5
    assert after[far].max() < 0.25 * before[far].max()
    assert np.median(np.abs(after - before)[~far]) < 0.02
