# SPDX-License-Identifier: MIT
"""The value of a covariate in each run of a table."""

import numpy as np

from model.arrays import Array
from model.similar_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.tables.covariate import StatedCovariate
from zebro_lab.tables.rig_table import RigTable
from zebro_lab.tables.run_separation import Runs

MOST_CHANGE = 0.1  # of the median, between the 5 and 95 % quantiles of a run


def run_values(table: RigTable, runs: Runs, stated: StatedCovariate) -> Array:
    """Return the median of a covariate in each run, shape (n_runs,), in its unit.

    Args:
        table: Rig table.
        runs: Run of each kept row.
        stated: The covariate.

    Raises:
        DataError: Its column is missing or has no numbers; a value is missing or not above 0; or
            it changes within a run by more than `MOST_CHANGE`.
    """
    if stated.header is None:
        return np.full(len(runs.names), stated.value)
    if stated.header not in table.raw.columns:
        raise table.raw.fault(
            f"is missing; {nearest(stated.header, list(table.raw.columns))}; correct "
            f"[covariates] {stated.name} in {table.columns.stated_in}, or state one value for all "
            "runs of the file there, value = NUMBER",
            stated.header,
        )
    values = table.raw.numbers(stated.header)[table.rows]
    good = np.isfinite(values) & (values > 0)
    if not good.all():
        row = int(np.argmin(good))
        raise table.raw.fault(
            f"{stated.name} is {values[row]:g}; expected numbers above 0 in every row, as the law "
            "follows its logarithm (temperatures in kelvin)",
            stated.header, int(table.rows[row]), value=float(values[row]), unit=stated.unit,
        )  # fmt: skip
    found = np.empty(len(runs.names))
    for index, name in enumerate(runs.names):
        own = values[runs.index == index]
        require_steady(table, stated, name, own)
        found[index] = np.median(own)
    return found


def require_steady(table: RigTable, stated: StatedCovariate, run: str, values: Array) -> None:
    """Raise `DataError` if a covariate changes within a run by more than `MOST_CHANGE`.

    Args:
        table: Rig table, for the message.
        stated: The covariate.
        run: Name of the run.
        values: Its values in the run, shape (n,).
    """
    low, middle, high = np.quantile(values, [0.05, 0.5, 0.95])
    if high - low > MOST_CHANGE * middle:
        raise DataError(
            f"{stated.name} goes from {low:.4g} to {high:.4g} {stated.unit}".rstrip()
            + f" within run '{run}'; expected one value for each run, within "
            f"{MOST_CHANGE:.0%}: separate runs where it changes, with [runs] by or gap",
            file=table.raw.path, column=stated.header,
        )  # fmt: skip
