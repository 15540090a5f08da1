# SPDX-License-Identifier: MIT
"""The corners of leg angles are cut where the benchmark says that they are."""

import numpy as np
import pandas as pd

from benchmarks.accuracy.pitch_spikes import DATA, leg_angles

LEGS = [f"theta{leg}" for leg in range(1, 7)]


def test_counts_rebuilt_at_their_samples_cut_the_corners_that_finer_times_keep():
    truth = pd.read_csv(DATA / "truth.csv")
    t, theta = truth["t"].to_numpy(), truth[LEGS].to_numpy()
    corners = 1.0 + 0.9 * np.arange(1, 29)  # tripods exchange, datasets/walk-sim/README.md
    rows = np.searchsorted(t, corners - 1e-6)
    exact, _, at_samples, fine = leg_angles(truth).values()

    def error(legs):
        return float(np.degrees(np.abs(legs.angles(t[rows]) - theta[rows]).mean()))

    assert error(exact) == 0
    assert error(fine) < 0.75 * error(at_samples)
