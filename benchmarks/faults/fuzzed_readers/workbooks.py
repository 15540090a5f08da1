# SPDX-License-Identifier: MIT
"""Readers of workbooks, of which every member is a text of its own."""

import io
import zipfile
from collections.abc import Mapping, Sequence
from datetime import UTC, date, datetime, time
from functools import cache
from typing import Any

import numpy as np
from openpyxl import Workbook

from benchmarks.faults.fuzzed_readers.reader import Reader, Take, zip_check
from benchmarks.faults.hostile_inputs import NUMBERS, changed_bytes, pick
from zebro_lab.runs.legs import read_leg_log

_BOOKS = 200
_SHEET = "xl/worksheets/sheet1.xml"
_ODD_CELLS = (
    None, "", "x", "1,5", "=1/0", "=A1", "#N/A", True, date(2026, 1, 1), time(1, 2),
    datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None), *(n for n in NUMBERS if n == n),
)  # fmt: skip


def of_workbooks(numbers: Take) -> Mapping[str, Reader]:
    """Return readers of workbooks.

    Args:
        numbers: Reads every column of a table.
    """
    return {
        "workbook, every column": Reader(
            "x.xlsx", numbers, _workbook, zip_check, inputs=10_000, special=_bombs
        ),
        "workbook of legs": Reader("x.xlsx", read_leg_log, _workbook, zip_check, inputs=10_000),
    }


def _workbook(rng: np.random.Generator) -> bytes:
    """Make a workbook, mostly with a changed member or changed bytes."""
    data = pick(rng, _books())
    kind = rng.random()
    if kind < 0.25:
        return data
    if kind < 0.5:
        return changed_bytes(data, rng)
    members = _members(data)
    name = pick(rng, [*members, _SHEET])
    if kind < 0.95:
        members[name] = changed_bytes(members[name], rng)
    else:
        del members[name]
    return _packed(members)


@cache
def _books() -> Sequence[bytes]:
    rng = np.random.default_rng(6)
    return [_book(rng) for _ in range(_BOOKS)]


def _book(rng: np.random.Generator) -> bytes:
    """Write a workbook of legs with up to three odd cells, rows or sheets."""
    rows: list[list[Any]] = [["t", *(f"theta{leg}" for leg in range(1, 7))]]
    rows += [[0.01 * k, *(0.03 * k,) * 6] for k in range(12)]
    for _ in range(int(rng.integers(0, 4))):
        row = pick(rng, rows)
        row[int(rng.integers(len(row)))] = pick(rng, _ODD_CELLS)
    if rng.random() < 0.2:
        rows.insert(0, [pick(rng, ("a title", None, 3))])
    book = Workbook()
    sheet = book.active
    assert sheet is not None
    for row in rows:
        sheet.append([each if not isinstance(each, int) or abs(each) < 2**60 else str(each)
                      for each in row])  # fmt: skip
    if rng.random() < 0.2:
        book.create_sheet("second").append(["t", 1])
    if rng.random() < 0.1:
        sheet.merge_cells("A1:B2")
    out = io.BytesIO()
    book.save(out)
    return out.getvalue()


def _members(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _packed(members: Mapping[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return out.getvalue()


def _bombs() -> tuple[bytes, ...]:
    """Return workbooks that unpack to much, nest entities, or name cells far away."""
    members = _members(_books()[0])
    sheet = members[_SHEET]
    laughs = b'<!DOCTYPE x [<!ENTITY a "ha">' + b"".join(
        b'<!ENTITY %c "%s">' % (98 + k, b"&%c;" % (97 + k) * 20) for k in range(9)
    )  # fmt: skip
    far = b'<row r="1048576"><c r="XFD1048576"><v>1</v></c></row></sheetData>'
    changed = (
        sheet.replace(b"<sheetData>", b"<sheetData>" + b" " * (300 << 20)),
        sheet.replace(b"</sheetData>", b'<row><c t="n"><v>1</v></c></row>' * 3_000_000
                      + b"</sheetData>"),
        laughs + b"]>" + sheet.replace(b"<v>", b"<v>&j;", 1),
        sheet.replace(b"</sheetData>", far),
        b"<a>" * 500_000,
    )  # fmt: skip
    return tuple(_packed({**members, _SHEET: each}) for each in changed)
