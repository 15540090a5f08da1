# SPDX-License-Identifier: MIT
"""Read the block means that a calibration was fitted to, from its `posterior.nc`."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.definition import SlipDefinition
from zebro_lab.calibration.draws import BLOCK_MOMENTS, read_draws_of
from zebro_lab.calibration.folder import POSTERIOR
from zebro_lab.files.errors import DataError

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


def read_slip_blocks(slip_toml: Path, definition: SlipDefinition) -> SlipBlocks:
    """Read the blocks beside a `slip.toml` with all that the likelihood takes of them.

    Runs are named by their number.

    Args:
        slip_toml: The calibration's `slip.toml`.
        definition: Its slip definition.

    Raises:
        NotFound: There is no `posterior.nc`.
        DataError: `posterior.nc` is damaged, or was written by a version that kept less of blocks.
    """
    file = slip_toml.parent / POSTERIOR
    names = ("slip_ratio", "normal_force", "run", "samples", *BLOCK_MOMENTS, "run_slip_error")
    given, _ = read_draws_of(file, "constant_data", names, advice=_ADVICE)
    forces, _ = read_draws_of(file, "observed_data", ["traction_force"], advice=_ADVICE)
    found = {**given, **forces}
    missing = [name for name in (*names, "traction_force") if name not in found]
    if missing:
        raise DataError(
            f"has no {', '.join(missing)} of its blocks; it is of an earlier version: calibrate "
            "again",
            file=file,
        )
    run = found["run"].astype(np.intp)
    if len({len(each) for each in found.values()}) > 1 or np.any(np.diff(run, prepend=0) < 0):
        raise DataError(f"has blocks that do not fit together; {_ADVICE}", file=file)
    _, run = np.unique(run, return_inverse=True)
    first = np.searchsorted(run, np.arange(run[-1] + 1))
    return SlipBlocks(
        slip=found["slip_ratio"],
        normal_force=found["normal_force"],
        traction_force=found["traction_force"],
        count=found["samples"].astype(np.intp),
        run=run,
        run_names=tuple(f"run {number}" for number in range(run[-1] + 1)),
        definition=definition,
        **{name: found[name] for name in BLOCK_MOMENTS},
        run_slip_error=found["run_slip_error"][first],
    )
