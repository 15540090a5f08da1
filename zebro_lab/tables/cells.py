# SPDX-License-Identifier: MIT
"""Error messages that name a table cell, and the check that times increase."""

import numpy as np

from model.slip.law import Array
from zebro_lab.files.errors import DataError
from zebro_lab.tables.raw_table import RawTable


def require_increasing(table: RawTable, column: str, t: Array) -> None:
    """Check that times are strictly increasing.

    Args:
        table: Table to name.
        column: Its column of times.
        t: Times by row, shape (n,) [s].

    Raises:
        DataError: A time is not later than the one before.
    """
    later = np.diff(t) > 0
    if later.all():
        return
    index = int(np.argmin(later)) + 1
    raise cell_error(
        table,
        column,
        index,
        f"time goes from {t[index - 1]:g} to {t[index]:g} s; expected increasing times: "
        "sort the rows, delete repeated ones",
    )


def cell_error(table: RawTable, column: str, index: int, problem: str) -> DataError:
    """Return an error that names a cell of a table.

    Args:
        table: Table to name.
        column: Header of the column.
        index: Data row, counted from 0.
        problem: What is wrong with the cell.
    """
    return DataError(
        problem, file=table.path, column=column, row=index + 1, line=table.line(index + 1)
    )
