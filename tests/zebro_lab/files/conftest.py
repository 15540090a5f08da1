# SPDX-License-Identifier: MIT
"""What tests of files that commands write share: a comparison of two calibrations."""

from collections.abc import Callable
from pathlib import Path

import pytest

from support.compared_folders import calibration
from zebro_lab.validation.compare.stage import compare


@pytest.fixture
def compared(tmp_path) -> Callable[[Path], object]:
    """Return what writes a comparison into a folder."""
    one = calibration(tmp_path / "one", friction=0.3)
    other = calibration(tmp_path / "other", friction=0.4)
    return lambda out: compare(one, other, out=out)
