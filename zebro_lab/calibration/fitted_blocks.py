# SPDX-License-Identifier: MIT
"""Read the block means that a calibration was fitted to, from its `posterior.nc`."""

from dataclasses import dataclass
from pathlib import Path

from model.slip.law import Array
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import POSTERIOR

_ADVICE = "delete it, or calibrate again"


@dataclass(frozen=True)
class FittedBlocks:
    """Block means of a calibration, in its slip definition.

    Attributes:
        slip: Slip ratio of each block, shape (n,) [-].
        normal_force: Normal force, shape (n,) [N].
        traction_force: Traction force, shape (n,) [N].
        definition: Slip definition.
    """

    slip: Array
    normal_force: Array
    traction_force: Array
    definition: str


def read_fitted_blocks(slip_toml: Path, definition: str) -> FittedBlocks | None:
    """Read the block means beside a `slip.toml`; None without a `posterior.nc` that has them.

    Args:
        slip_toml: The calibration's `slip.toml`.
        definition: Its slip definition.

    Raises:
        DataError: `posterior.nc` is damaged.
    """
    file = slip_toml.parent / POSTERIOR
    if not file.is_file():
        return None
    forces, _ = read_draws_of(file, "observed_data", ["traction_force"], advice=_ADVICE)
    given, _ = read_draws_of(file, "constant_data", ["slip_ratio", "normal_force"], advice=_ADVICE)
    found = {**forces, **given}
    if len(found) < 3 or len({len(values) for values in found.values()}) > 1:
        return None
    return FittedBlocks(
        found["slip_ratio"], found["normal_force"], found["traction_force"], definition
    )
