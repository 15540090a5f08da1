# SPDX-License-Identifier: MIT
"""Format guessed columns as a commented `columns.toml`; each guess to check ends in "?"."""

import re
from collections.abc import Mapping
from typing import Final

import numpy as np
import tomlkit

from model.slip.definition import SlipDefinition
from zebro_lab.exchange.column_guesses import UNITS, ColumnGuess, numbers_or_none
from zebro_lab.exchange.column_names import MEAN_SLIP, split_header
from zebro_lab.tables.columns import COLUMNS_FILE, IMU, LEGS, RIG, TRACK
from zebro_lab.tables.columns_sections import DOUBT
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import CANONICAL
from zebro_lab.tables.slip_source import DISCS

_READS: Final = {
    RIG: "calibrate-slip reads", LEGS: "predict and import --legs read",
    IMU: "import --imu reads", TRACK: "import --track reads",
}  # fmt: skip
_TOP: Final = """\
# How the columns of {file} map to those that {reads}.
# A value that ends in "?" is a guess: compare it with the table, correct it where it is wrong, and
# delete the "?". Until then no command reads the table. docs/formats.md explains every key.
# It applies to all tables of this kind in this folder, and in subfolders without a {columns_file}
# for this kind.
"""
_SOURCE: Final = """
# Where the data come from: "real", or "sim:WHAT" for simulated data.
# source = "real"
"""
_CONSTANTS: Final = """
[{at}constants]  # numbers in SI, or texts with a unit
# radius_leg = "35 mm"    # needed for slip from the disc speeds
# radius_ground = "120 mm"
{load}normal_force = "{doubt}"  # NEEDED without a column of it: the load of all rows, as "6.6 N"
"""
_RUNS: Final = """
[{at}runs]  # what separates runs, one of these; default: a column 'run', else files
# by = ["SET_POINT"]  # columns that change from run to run; needed where time restarts in the file
# gap = "1 s"         # a pause longer than this starts a run
{trials}  # true if every row is the mean of a trial, false for a recording
# leave_out = [12]    # numbers of runs that are not read, of rows where each is one
"""
_ROWS: Final = """
[{at}rows]  # only rows that meet all of these are read; names with < > = ! stand in backticks
# keep = ["{column} > 0"]
"""
_LOAD_CELL: Final = """
[{at}load_cell]  # standard deviations, from the certificate or a check with known weights
# zero_stability = "0.15 N"  # of the zero between runs
# gain_sd = 0.005
# bias_sd = "0.05 N"
# crosstalk_sd = 0.005

[{at}rig_errors]  # standard deviations, of what a fit of both sides of zero slip estimates
# radius = "0.1 mm"  # of each disc
# rolling_resistance = 0.02  # over the load
# run_out = "0.05 mm"  # of each disc, amplitude over a turn
"""
_MEANINGS: Final = {
    "t": "time, increasing", "t_s": "time, increasing", "x_m": "position in the floor frame",
    "y_m": "position, to the left of x", "z_m": "height", "yaw_rad": "positive to the left",
    "roll": "positive with the left side up", "pitch": "positive with the nose down",
    "yaw": "positive to the left",
    **{f"q{axis}": "quaternion from the body's frame to the floor's" for axis in "wxyz"},
    **{f"rate_{axis}": "angular rate of the body, in its frame" for axis in "xyz"},
    **{f"force_{axis}": "specific force (9.81 m/s^2 upwards at rest)" for axis in "xyz"},
}  # fmt: skip


def render_columns(
    table: RawTable,
    kind: str,
    guesses: Mapping[str, ColumnGuess],
    *,
    sheet: str | None = None,
    sectioned: bool = False,
    appended: bool = False,
) -> str:
    """Format the guessed column map of a table as commented TOML, with a summary of each column.

    Args:
        table: The table.
        kind: Kind of the table.
        guesses: Guessed columns by canonical name.
        sheet: Sheet of the workbook; None for other tables.
        sectioned: Whether the entries are in a section [KIND].
        appended: Whether the text follows other sections.
    """
    at = f"{kind}." if sectioned else ""
    used = {guess.name for guess in guesses.values()}
    others = {name: table.units.get(name) for name in table.columns if name not in used}
    head = _TOP.format(file=table.path.name, reads=_READS[kind], columns_file=COLUMNS_FILE)
    text = head + ("" if appended else _SOURCE)
    text += f"\n[{kind}]\n" if sectioned else ""
    text += f"\nsheet = {_quoted(sheet)}\n" if sheet is not None else ""
    text += "".join(_column(table, name, kind, guesses, at) for name in UNITS[kind])
    if kind == RIG:
        column = _quoted(f"`{next(iter(table.columns))}`")[1:-1]
        timed = {"t", "run"} & guesses.keys()
        text += _CONSTANTS.format(at=at, load="# " * ("normal_force" in guesses), doubt=DOUBT)
        trials = "# each_row = true   " if timed else f'each_row = "{DOUBT}"'
        text += _RUNS.format(at=at, trials=trials)
        text += _ROWS.format(at=at, column=column) + _LOAD_CELL.format(at=at)
    listed = "".join(
        f"#   {_quoted(name)}: {_summary(table, name)}{f', in {unit}' if unit else ''}\n"
        for name, unit in others.items()
    )
    return text + ("\n# Columns not used:\n" + listed if others else "")


def _column(
    table: RawTable, name: str, kind: str, guesses: Mapping[str, ColumnGuess], at: str
) -> str:
    """Format the section of a canonical column, each doubtful value with "?" and a comment why.

    A column without a guess is an entry in comments, to be filled in; covariances are left out.
    """
    guess, meaning = guesses.get(name), _meaning(name, kind)
    if guess is None:
        missing = kind == RIG or name in _MEANINGS or name.startswith("theta")
        return f'\n# [{at}columns.{name}]  # {meaning}\n# name = ""\n' if missing else ""
    lines = [
        f"[{at}columns.{name}]  # {meaning}",
        _line("name", guess.name, guess.name_doubt, _summary(table, guess.name)),
    ]
    if guess.nanoseconds is not None:
        lines.append(f"nanoseconds = {_quoted(guess.nanoseconds)}")
    if guess.unit is not None:
        lines.append(_line("unit", guess.unit.unit, guess.unit.doubt))
    if guess.sign_doubt:
        lines.append(_line("sign", str(guess.sign), guess.sign_doubt))
    if guess.zero_doubt:
        lines.append(_line("offset", "0 deg", guess.zero_doubt))
    if name == "slip_ratio":
        lines = _slip_lines(lines, guesses)
    return "\n" + "\n".join(lines) + "\n"


def _slip_lines(lines: list[str], guesses: Mapping[str, ColumnGuess]) -> list[str]:
    """Add the slip definition that is needed to the lines of a slip ratio without a column for it.

    All lines become comments where both disc speeds are there, from which slip is computed.
    """
    is_mean = re.fullmatch(MEAN_SLIP, split_header(guesses["slip_ratio"].name)[0])
    meant = SlipDefinition.MEAN if is_mean else ""
    if "slip_definition" not in guesses:
        lines += [f'definition = "{meant}{DOUBT}"  # NEEDED: material, travel, larger or mean']
    if all({f"omega_{disc}", f"speed_{disc}"} & guesses.keys() for disc in DISCS):
        note = "# Slip comes from the disc speeds; to use this column, uncomment:"
        return [note, *(f"# {line}" for line in lines)]
    return lines


def _line(key: str, value: str, doubt: str, more: str = "") -> str:
    """Format an entry `key = "value"`; a doubt adds "?" to the value and is told in the comment."""
    comment = "; ".join(text for text in (more, f"CHECK: {doubt}" if doubt else "") if text)
    return f"{key} = {_quoted(value + DOUBT * bool(doubt))}" + (f"  # {comment}" if comment else "")


def _meaning(name: str, kind: str) -> str:
    """Return what a canonical column means, in a few words for the comment beside it."""
    if kind == RIG:
        return CANONICAL[name].meaning
    if kind == LEGS and name != "t":
        return f"angle of leg {name[-1]}, growing as the robot walks forward"
    return _MEANINGS.get(name, "of the body, in its frame" if kind == IMU else "covariance")


def _summary(table: RawTable, name: str) -> str:
    """Return first, least and largest number of a column; of other columns the first cell."""
    numbers = numbers_or_none(table, name)
    if numbers is None:
        return f"first {_quoted(str(table.columns[name].iloc[0])[:40])}"
    low, high = np.nanmin(numbers), np.nanmax(numbers)
    return f"first {numbers[0]:.10g}, from {low:.10g} to {high:.10g}"


def _quoted(text: str) -> str:
    """Return a text as a TOML string, with quotes and escapes."""
    return tomlkit.string(text).as_string()
