# SPDX-License-Identifier: MIT
"""A reader of a file that a user brings, and the first checks of its inputs."""

import csv
import io
import json
import tomllib
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import h5py
import PIL.Image

from benchmarks.faults.hostile_inputs import (
    Make,
)

Take = Callable[[Path], object]
Check = Callable[[bytes], object]
HUNDRED_THOUSAND, TEN_THOUSAND = 100_000, 10_000


@dataclass(frozen=True)
class Reader:
    """A reader and its inputs.

    Attributes:
        file: Name of the file that is written for each input.
        read: Reads that file.
        make: Makes an input.
        check: Raises where an input fails the first check: it is no TOML, no zip archive …
        inputs: How many are read in a whole trial.
        prepare: Writes what lies beside the file, once.
        special: Makes inputs that are read first: bombs.
    """

    file: str
    read: Take
    make: Make
    check: Check
    inputs: int = HUNDRED_THOUSAND
    prepare: Callable[[Path], object] | None = None
    special: Callable[[], tuple[bytes, ...]] = tuple


def toml_check(data: bytes) -> object:
    """Parse TOML."""
    return tomllib.loads(data.decode("utf-8-sig"))


def json_check(data: bytes) -> object:
    """Parse JSON."""
    return json.loads(data)


def csv_check(data: bytes) -> None:
    """Take a text for a table: a header and a row of as many cells."""
    text = data.decode("utf-8-sig")
    rows = list(csv.reader(io.StringIO(text), delimiter=next(c for c in ",;\t|" if c in text)))
    if len(rows) < 2 or len(rows[0]) != len(rows[1]):
        raise ValueError("no table")


def zip_check(data: bytes) -> None:
    """Open an archive and read its members."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if not archive.namelist() or archive.testzip():
            raise ValueError("damaged")


def hdf_check(data: bytes) -> None:
    """Open an HDF5 file."""
    h5py.File(io.BytesIO(data), "r").close()


def mcap_check(data: bytes) -> None:
    """Read the magic and the first record of a log."""
    from mcap.stream_reader import StreamReader

    next(StreamReader(io.BytesIO(data)).records)


def picture_check(data: bytes) -> None:
    """Identify a picture."""
    PIL.Image.open(io.BytesIO(data)).close()


def text_check(data: bytes) -> object:
    """Decode a text."""
    return data.decode("utf-8-sig")
