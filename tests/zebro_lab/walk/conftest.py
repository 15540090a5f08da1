# SPDX-License-Identifier: MIT
"""Leg logs and a calibration for tests of what walks inform."""

import pytest

from support.walk_posteriors import (
    write_calibration,
    write_legs,
)


@pytest.fixture
def legs(tmp_path):
    """Return two leg logs."""
    return write_legs(tmp_path)


@pytest.fixture
def calibration(tmp_path):
    """Return a calibration without walks."""
    return write_calibration(tmp_path)
