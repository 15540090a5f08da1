# SPDX-License-Identifier: MIT
"""Draw slip laws from a calibration's posterior; an assumed law has a single draw."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.slip.curve import SlipCurve
from model.walk.traction import TractionTable, VelocityCoulomb, law_table
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import POSTERIOR
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.files.errors import DataError

_ADVICE = f"delete it and calibrate again, or choose a slip.toml without {POSTERIOR} beside it"
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
        n: Number of draws.
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
    return rng.multivariate_normal(curve.values, curve.covariance, size=n, method="eigh")


def _posterior(file: Path, curve: SlipCurve) -> Array:
    """Read the posterior draws of a law, shape (m, k).

    A parameter without draws, a fixed one, has the curve's value; without draws of any, the file is
    of another law and `DataError` is raised.
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
