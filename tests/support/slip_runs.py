# SPDX-License-Identifier: MIT
"""Samples of runs with given slips, and the noise and wander that slips can have."""

import numpy as np
from scipy.signal import lfilter

from model.slip import SlipDefinition
from model.slip.samples import SlipSamples


def samples(slip_runs, seed=0):
    """Return samples of runs with these slips and random forces."""
    rng = np.random.default_rng(seed)
    lengths = [len(slip) for slip in slip_runs]
    n = sum(lengths)
    return SlipSamples(
        slip=np.concatenate([np.asarray(slip, dtype=float) for slip in slip_runs]),
        normal_force=rng.uniform(4.0, 6.0, n),
        traction_force=rng.uniform(0.0, 2.0, n),
        run=np.repeat(np.arange(len(lengths)), lengths),
        run_names=tuple(f"run {index}" for index in range(len(lengths))),
        definition=SlipDefinition.MATERIAL,
    )


def white(rng, shape, sd):
    return sd * rng.standard_normal(shape)


def wander(rng, shape, sd, *, steps):
    """Draw Ornstein-Uhlenbeck paths, one a row, with a correlation time in samples."""
    rho = np.exp(-1 / steps)
    shock = rng.standard_normal(shape)
    shock[:, 1:] *= np.sqrt(1 - rho**2)
    return sd * lfilter([1.0], [1.0, -rho], shock, axis=1)


def mean_of_blocks(values, count):
    starts = np.append(0, np.cumsum(count)[:-1])
    return np.add.reduceat(values, starts) / count
