# SPDX-License-Identifier: MIT
"""Runs and devices, used as a notebook would."""

import pytest

import zebro_lab as zl
from zebro_lab.files.errors import ZebroLabError


def test_twins_are_opened_and_read():
    with zl.open_devices(zebro="sim") as devices:
        (legs,) = devices.devices
        samples = [legs.stream.read(timeout=1.0) for _ in range(3)]
    assert any(samples)


def test_a_missing_run_is_said(tmp_path):
    with pytest.raises(ZebroLabError):
        zl.open_run(tmp_path / "nothing")
