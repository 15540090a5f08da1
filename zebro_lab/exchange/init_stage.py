# SPDX-License-Identifier: MIT
"""Write a commented `columns.toml` for a table, guessed from its header."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from zebro_lab.exchange.column_guesses import (
    ColumnGuess,
    guess_columns,
    guess_set_points,
    numbers_or_none,
)
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.tables.columns import CANONICAL, COLUMNS_FILE
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file

_TOP = """\
# How the columns of {file} map to the columns that calibrate-slip reads.
# Guessed from the header: check names, units and signs. docs/formats.md explains every key.
# It applies to all tables in this folder and in subfolders that have no {columns_file}.

# Where the data come from: "real", or "sim:WHAT" for simulated data.
# source = "real"
"""
_CONSTANTS = """
[constants]  # numbers in SI, or texts with a unit
# radius_leg = "35 mm"    # needed for slip from the disc speeds
# radius_ground = "120 mm"
"""
_ROWS = """
[rows]  # only rows that meet all of these are read; put names in backticks if they contain < > = !
# keep = ["{column} > 0"]
"""
_LOAD_CELL = """
[load_cell]  # standard deviations, from the certificate or a check with known weights
# zero_stability = "0.15 N"  # of the zero between runs
# gain_sd = 0.005
# bias_sd = "0.05 N"
# crosstalk_sd = 0.005
"""


def write_columns_template(file: Path, *, force: bool = False) -> Path:
    """Write a commented `columns.toml` beside a table, guessed from its header and numbers.

    Args:
        file: CSV or Parquet file with the table.
        force: Whether to replace an existing `columns.toml`.

    Returns:
        The written `columns.toml`.

    Raises:
        NotFound: The table file does not exist.
        DataError: The table cannot be read.
        AlreadyExists: A `columns.toml` exists beside the table, and `force` is not set.
        OSError: The file cannot be written.
    """
    file = Path(file)
    target = file.parent / COLUMNS_FILE
    if target.exists() and not force:
        raise AlreadyExists(f"{target} exists already; edit that file, or replace it with --force")
    return atomic_write_text(target, render_template(read_table_file(file)))


def render_template(table: RawTable) -> str:
    """Format the guessed column map of a table as commented TOML, with a summary per column."""
    guesses = guess_columns(table)
    used = {guess.name for guess in guesses.values()}
    others = [name for name in table.columns if name not in used]
    return "".join([
        _TOP.format(file=table.path.name, columns_file=COLUMNS_FILE),
        *(_column_section(table, name, guesses) for name in CANONICAL),
        _CONSTANTS,
        _runs_section(table, guesses),
        _ROWS.format(column=_bare(next(iter(table.columns)))),
        _LOAD_CELL,
        "\n# Columns not used:\n" if others else "",
        *(f"#   {_quoted(name)}: {_summary(table, name)}\n" for name in others),
    ])  # fmt: skip


def _column_section(table: RawTable, name: str, guesses: Mapping[str, ColumnGuess]) -> str:
    canonical, guess = CANONICAL[name], guesses.get(name)
    if guess is None:
        return f'\n# [columns.{name}]  # {canonical.meaning}\n# name = ""\n'
    lines = [
        f"[columns.{name}]  # {canonical.meaning}",
        f"name = {_quoted(guess.name)}  # {_summary(table, guess.name)}",
    ]
    if guess.others:
        lines[-1] += f"; CHECK: could also be {', '.join(map(_quoted, guess.others))}"
    if canonical.unit is not None:
        check = "from its header" if guess.unit else "CHECK: the header shows no fitting unit"
        lines.append(f"unit = {_quoted(guess.unit or canonical.unit)}  # {check}")
    if name == "normal_force":
        sign = "-1  # negative in the file" if guess.negative else "1"
        lines.append(f"sign = {sign}")
    elif name == "traction_force":
        lines.append("sign = 1  # CHECK: use -1 if the force in the file is positive when braking")
    elif name == "slip_ratio":
        lines.append('# definition = "material"  # NEEDED: material, travel or larger')
        if {"omega_leg", "omega_ground"} <= guesses.keys():
            lines.insert(0, "# Slip comes from the disc speeds; to use this column, uncomment:")
            lines[1:] = [line if line.startswith("#") else f"# {line}" for line in lines[1:]]
    return "\n" + "\n".join(lines) + "\n"


def _runs_section(table: RawTable, guesses: Mapping[str, ColumnGuess]) -> str:
    by = ", ".join(map(_quoted, guess_set_points(table)))
    restarts = "t" in guesses and _runs_backwards(table, guesses["t"].name)
    # Without a rule such a file cannot be read at all, so a guess is better than a comment.
    active = "" if restarts and by else "# "
    by = by or _quoted("SET_POINT")
    check = "  # CHECK: time restarts in the file" if restarts else ""
    return (
        "\n[runs]  # what separates runs: one of these; default: a column 'run', else each file\n"
        f"{active}by = [{by}]{check}\n"
        '# gap = "1 s"      # a pause longer than this starts a run\n'
        "# each_row = true  # every row is the mean of a trial\n"
    )


def _runs_backwards(table: RawTable, name: str) -> bool:
    time = numbers_or_none(table, name)
    return time is not None and bool((np.diff(time) < 0).any())


def _summary(table: RawTable, name: str) -> str:
    numbers = numbers_or_none(table, name)
    if numbers is None:
        return f"first {_quoted(str(table.columns[name].iloc[0])[:40])}"
    low, high = np.nanmin(numbers), np.nanmax(numbers)
    return f"first {numbers[0]:g}, from {low:g} to {high:g}"


def _bare(name: str) -> str:
    quoted = _quoted(f"`{name}`")
    return quoted[1:-1]


def _quoted(text: str) -> str:
    import tomlkit

    return tomlkit.string(text).as_string()
