# SPDX-License-Identifier: MIT
"""Logged servo angles of simulated walks follow the references that were asked of them."""

import json

import numpy as np
import pandas as pd
import pytest

from model.gait.steering import TripodAngles, tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference

LEGS = [f"th{leg}" for leg in range(1, 7)]


def asked_of(meta):
    """Build the reference from a walk's own description."""
    gait = meta["gait"]
    down, up = np.radians(gait["TD_deg"]), np.radians(gait["LO_deg"])
    if gait["kind"] == "tetrapod":
        return tetrapod_reference(down[0], up[0], cycle_time=gait["period_s"])
    inner, outer = (0, 1) if gait["turn"] == "left" else (1, 0)
    angles = TripodAngles(down[inner], up[inner], down[outer], up[outer])
    return tripod_reference(angles, gait["period_s"], direction=gait["turn"])


def walks(shared):
    for path in sorted((shared / "virtual-world" / "walks").glob("*.json")):
        meta = json.loads(path.read_text(encoding="utf-8"))
        yield path.stem, meta, pd.read_csv(path.with_suffix(".csv.gz"), usecols=["t", *LEGS])


@pytest.mark.reference
def test_servos_follow_within_a_fifth_of_a_degree_and_without_lag(shared):
    for name, meta, log in walks(shared):
        reference = asked_of(meta)
        t = log["t"].to_numpy()
        error = log[LEGS].to_numpy() - reference.angles(t)
        error -= 2 * np.pi * np.round(error[0] / (2 * np.pi))
        assert np.degrees(np.abs(error)).max() < 0.2, name
        # A lag would show as an error in proportion to the speed.
        speed = reference.speeds(t)
        deviation = speed - speed.mean(axis=0)
        lag = -(error * deviation).sum() / (deviation**2).sum()
        assert abs(lag) < 1e-4, (name, lag)


@pytest.mark.reference
def test_angles_asked_of_the_servos_come_from_touchdown_and_steering_factor(shared):
    for name, meta, _ in walks(shared):
        gait, arc = meta["gait"], np.radians(meta["params"]["arc"])
        if gait["kind"] != "tripod" or name.endswith("real"):  # the real ones were measured
            continue
        outer = 1 if gait["turn"] == "left" else 0
        angles = tripod_angles(np.radians(gait["TD_deg"][1 - outer]), gait["s"], leg_arc=arc)
        found = np.degrees([angles.outer_touchdown, angles.outer_liftoff, angles.inner_liftoff])
        expected = [gait["TD_deg"][outer], gait["LO_deg"][outer], gait["LO_deg"][1 - outer]]
        np.testing.assert_allclose(found, expected, atol=1e-4, err_msg=name)
