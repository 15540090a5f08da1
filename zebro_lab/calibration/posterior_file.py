# SPDX-License-Identifier: MIT
"""Read `posterior.nc` beside a `slip.toml`: draws of the law, and the blocks that were fitted."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.errors import DomainError
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.walk.traction import TractionTable, VelocityCoulomb, law_table
from zebro_lab.calibration.draws import BLOCK_MOMENTS, read_draws_of
from zebro_lab.calibration.folder import POSTERIOR
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.files.errors import DataError

_ADVICE = f"delete it and calibrate again, or choose a slip.toml without {POSTERIOR} beside it"
_ANEW = "delete it, or calibrate again"
MOST_TABLES = 200  # a table costs as much as 1 s of simulated walk, and paths hardly differ by it


def slip_tables(
    slip: NamedSlip, n: int, *, weight: float, rng: np.random.Generator
) -> list[TractionTable]:
    """Compute interpolation tables of traction, one for each draw of a slip law.

    Draws that are invalid at the robot's loads are skipped; if all are, the only table is that of
    the posterior mean. A law with zero covariance has one draw, its values.

    Args:
        slip: Slip law named by `--slip`.
        n: Number of draws; at most `MOST_TABLES` are made, one for an assumed law.
        weight: Weight of the robot [N].
        rng: Random number generator.

    Raises:
        DataError: The posterior beside the slip.toml is damaged or of another law.
        DomainError: All draws and the mean are invalid at the robot's loads.
    """
    law = slip.law
    if isinstance(law, VelocityCoulomb):
        return [law.table(weight=weight)]
    tables = []
    for values in law_draws(slip, law, min(n, MOST_TABLES), rng=rng):
        try:
            tables.append(law_table(law.law, values, weight=weight, definition=law.definition))
        except DomainError:  # a draw from the tail that is invalid at this robot's loads
            continue
    return tables or [slip.traction_table(weight=weight)]


def law_draws(slip: NamedSlip, curve: SlipCurve, n: int, *, rng: np.random.Generator) -> Array:
    """Draw a law's parameters from `posterior.nc` beside the slip.toml, else from the Gaussian.

    Args:
        slip: Slip law named by `--slip`.
        curve: Slip curve of this law, with the mean and covariance of the Gaussian.
        n: Number of draws; of the file they are drawn with replacement only if it has fewer.
        rng: Random number generator.

    Returns:
        Values, one draw per row, shape (n, k); shape (1, k), the mean, if the covariance is zero.

    Raises:
        DataError: The posterior beside the slip.toml is damaged or of another law.
    """
    if not np.any(curve.covariance):
        return curve.values[None]
    posterior = slip.files[0].parent / POSTERIOR if slip.files else None
    if posterior is not None and posterior.is_file():
        drawn = _posterior(posterior, curve)
        return drawn[rng.choice(len(drawn), size=n, replace=n > len(drawn))]
    # by eigenvalues, since the covariance is singular where a parameter is fixed
    return rng.multivariate_normal(curve.values, curve.covariance, size=n, method="eigh")


def _posterior(file: Path, curve: SlipCurve) -> Array:
    """Read the posterior draws of a law, shape (m, k).

    A parameter without draws has the curve's value throughout; without draws of any, the file is of
    another law and `DataError` is raised.
    """
    names = [parameter.name for parameter in curve.law.parameters]
    columns, others = read_draws_of(file, "posterior", names, advice=_ADVICE)
    drawn = list(columns)
    if not drawn:
        raise DataError(
            f"holds draws of {', '.join(others) or 'nothing'}, but the slip.toml beside it is of "
            f"the law '{curve.law.name}' with {', '.join(names)}; {_ADVICE}",
            file=file,
        )
    m = len(columns[drawn[0]])
    fixed = dict(zip(names, curve.values, strict=True))
    return np.column_stack([columns.get(name, np.full(m, fixed[name])) for name in names])


def read_block_means(slip_toml: Path) -> Array:
    """Read the block means that a calibration was fitted to, in its slip definition.

    Args:
        slip_toml: The calibration's `slip.toml`.

    Returns:
        Slip ratio [-], normal force and traction force [N], shape (3, n); n is 0 without a
        `posterior.nc` that has them.

    Raises:
        DataError: `posterior.nc` is damaged.
    """
    file = slip_toml.parent / POSTERIOR
    if not file.is_file():
        return np.empty((3, 0))
    given, _ = read_draws_of(file, "constant_data", ["slip_ratio", "normal_force"], advice=_ANEW)
    forces, _ = read_draws_of(file, "observed_data", ["traction_force"], advice=_ANEW)
    found = list({**given, **forces}.values())
    if len(found) < 3 or len({len(values) for values in found}) > 1:
        return np.empty((3, 0))
    return np.stack(found)


def read_slip_blocks(slip_toml: Path, definition: SlipDefinition) -> SlipBlocks:
    """Read the blocks beside a `slip.toml` with all that the likelihood takes of them.

    Runs are named by their number.

    Args:
        slip_toml: The calibration's `slip.toml`.
        definition: Its slip definition.

    Raises:
        NotFound: There is no `posterior.nc`.
        DataError: `posterior.nc` is damaged, its arrays differ in length or its blocks are not in
            the order of runs, or it was written by a version that kept less of blocks.
    """
    file = slip_toml.parent / POSTERIOR
    names = ("slip_ratio", "normal_force", "run", "samples", *BLOCK_MOMENTS, "run_slip_error")
    given, _ = read_draws_of(file, "constant_data", names, advice=_ANEW)
    forces, _ = read_draws_of(file, "observed_data", ["traction_force"], advice=_ANEW)
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
        raise DataError(f"has blocks that do not fit together; {_ANEW}", file=file)
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
