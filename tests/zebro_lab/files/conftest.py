# SPDX-License-Identifier: MIT
"""What tests of files that commands write share: a comparison of two calibrations."""

from collections.abc import Callable
from pathlib import Path

import pytest

from zebro_lab.validation.compare.stage import CompareRequest, compare

SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "material"
law = {{ name = "coulomb-stribeck", stribeck = false }}
[parameters]
slip_stiffness = {{ mean = 20.0 }}
friction = {{ mean = {friction} }}
[covariance]
matrix = [[1.0, 0.0], [0.0, 1e-4]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
"""


def calibration(folder: Path, friction: float) -> Path:
    folder.mkdir(parents=True)
    (folder / "slip.toml").write_text(SLIP_TOML.format(friction=friction))
    return folder


@pytest.fixture
def compared(tmp_path) -> Callable[[Path], None]:
    """Return what writes a comparison into a folder."""
    one, other = calibration(tmp_path / "one", 0.3), calibration(tmp_path / "other", 0.4)
    return lambda out: void(compare(CompareRequest(one, other, out)))


def void(_: object) -> None:
    """Forget what a stage returns."""
