# SPDX-License-Identifier: MIT
"""Profiles of the robot: counts to angles, and faults of a profile's file."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.device import Sample
from rig.errors import ProfileError, ProtocolError
from rig.zebro.profile import (
    decode_angles,
    encode_counts,
    load_leg_profile,
    save_leg_profile,
)
from support.malformed_profiles import require_refused

PACKETS, POLLED = "zebro-100-serial", "zebrobus-uart"
LEG_PROFILES = ["vregs-dump", "zebro-100-can", "zebro-100-serial", "zebrobus-uart"]

profiles = st.builds(
    lambda legs, counts, zeros, sign: replace(
        load_leg_profile("zebro-100-serial"),
        legs=tuple(legs),
        counts_per_revolution=counts,
        zero_counts=tuple(zeros),
        sign=tuple(sign),
    ),
    st.permutations(range(1, 7)),
    st.integers(50, 910),
    st.lists(st.floats(0, 50), min_size=6, max_size=6),
    st.lists(st.sampled_from([1, -1]), min_size=6, max_size=6),
)


def samples_of(profile, theta):
    return [Sample(0.01 * k, None, k, encode_counts(profile, row)) for k, row in enumerate(theta)]


@given(profiles, st.integers(0, 2**32 - 1))
def test_angles_come_back_within_half_a_count_and_unwrapped(profile, seed):
    rng = np.random.default_rng(seed)
    theta = np.cumsum(rng.uniform(0, 0.8 * np.pi, (40, 6)), axis=0)
    decoded = decode_angles(profile, samples_of(profile, theta))
    turns = np.round((theta[0] - decoded.theta[0]) / (2 * np.pi)) * 2 * np.pi
    error = decoded.theta + turns - theta
    assert np.max(np.abs(error)) <= profile.quantisation + 1e-9
    assert decoded.legs == (1, 2, 3, 4, 5, 6)


@given(profiles)
def test_a_full_revolution_reads_as_zero(profile):
    counts = [(0,) * 6, (profile.counts_per_revolution,) * 6]
    angles = [decode_angles(profile, [Sample(0, None, 0, c)]).theta for c in counts]
    np.testing.assert_allclose(angles[0], angles[1], atol=1e-9)


def test_a_wrong_zero_is_repaired_by_the_profile_without_a_new_recording():
    wrong = load_leg_profile("zebro-100-serial")
    true = replace(wrong, zero_counts=(0, 0, 0, 0, 1.4, 0))
    theta = np.outer(np.linspace(0, 8, 60), np.ones(6))
    recording = samples_of(true, theta)
    repaired = decode_angles(true, recording).theta - theta
    assert np.max(np.abs(repaired)) <= true.quantisation + 1e-9
    off = decode_angles(wrong, recording).theta - theta
    assert np.degrees(off[:, 4].mean()) == pytest.approx(1.4 * 3.6, abs=0.5)


def test_samples_of_another_device_are_refused():
    with pytest.raises(ProtocolError, match="1 channels"):
        decode_angles(load_leg_profile("zebro-100-serial"), [Sample(0, None, 0, (1,))])


@pytest.mark.parametrize("name", LEG_PROFILES)
def test_a_saved_profile_comes_back(name, tmp_path):
    profile = load_leg_profile(name)
    profile = replace(profile, legs=profile.legs[::-1], sign=(-1, *profile.sign[1:]))
    save_leg_profile(profile, tmp_path / f"{name}.toml")
    assert load_leg_profile(str(tmp_path / f"{name}.toml")) == profile


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        (PACKETS, "counts_per_revolution", "counts_per_revolutoin", "mean 'counts_per_revolution'"),
        (PACKETS, "rate = 100.0", "rate = nan", "finite"),
        (PACKETS, "order = [1, 2", "order = [1, 1", "different leg numbers"),
        (PACKETS, "order = [1, 2, 3, 4, 5, 6]", "order = [1, 2, 3]", "six"),
        (PACKETS, "sign = [1,", "sign = [2,", "1 or -1"),
        (PACKETS, 'layout = "packet"', 'layout = "can"', "needs 'can'"),
        (PACKETS, 'device = "legs"', 'device = "imu"', "device: found 'imu'; expected"),
        (PACKETS, "schema = 1", "schema = 2", "schema"),
        (PACKETS, "[link]", "[link", "TOML"),
        (PACKETS, "baudrate = 3000000", 'baudrate = "fast"', "whole number"),
        (POLLED, "set_point_registers = [", "set_point_registers = [] # [", "[]; expected 6"),
        (POLLED, "set_point_registers = [", "set_point_registers = [1, ", "; expected [1, 3"),
        (POLLED, "duration_register = ", "duration_register = 1  # ", "next after the set-points"),
    ],
)  # fmt: skip
def test_a_malformed_profile_is_refused_and_the_place_named(tmp_path, name, old, new, said):
    require_refused(load_leg_profile, tmp_path, name, old, new, said)


@given(st.text(max_size=200))
def test_any_text_is_a_profile_or_a_profile_error(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("profile") / "any.toml"
    path.write_text(text, encoding="utf-8", errors="replace")
    with pytest.raises(ProfileError):
        load_leg_profile(str(path))
