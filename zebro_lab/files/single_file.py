# SPDX-License-Identifier: MIT
"""Overwrite a single output file only if the same command wrote it."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from zebro_lab.files.errors import AlreadyExists, NotFound
from zebro_lab.files.folder_manifest import MANIFEST, listed_outputs
from zebro_lab.files.picture_format import PictureFormat

_SEARCHED: Final = 1 << 16
"""Number of leading, and of trailing, bytes that are searched for the mark of a command."""
SOFTWARE: Final = "zebro-lab"
COMMENT: Final = "Comment"
"""PNG keyword under which a picture names the command that drew it."""
_DRAWN_BY: Final = "drawn by zebro-lab "
"""Begins the description of an SVG, and the subject of a PDF, that names its command."""


@dataclass(frozen=True)
class SingleFile:
    """A kind of single file that one command writes, and how such a file is recognised.

    Attributes:
        command: The command, as shown in messages.
        marks: By the bytes that such a file begins with, those that its first or last 64 KiB
            contain.
    """

    command: str
    marks: Mapping[bytes, bytes]


def picture(command: str) -> SingleFile:
    """Return the kind of a picture that a command draws, recognised by `picture_metadata`."""
    drawn = f"{_DRAWN_BY}{command}"
    content = f"{COMMENT}\0{command}".encode("latin-1")
    png = len(content).to_bytes(4, "big") + b"tEXt" + content
    svg, pdf = f"<dc:description>{drawn}</dc:description>", f"/Subject ({drawn})"
    marks = {b"\x89PNG\r\n\x1a\n": png, b"<?xml": svg.encode(), b"%PDF-": pdf.encode()}
    return SingleFile(command, marks)


def picture_metadata(form: PictureFormat, command: str | None) -> dict[str, str | None]:
    """Return the metadata of a picture, as matplotlib takes it, without time and version.

    Args:
        form: Format of the picture.
        command: Command that draws it; None to name none.
    """
    if form == "png":
        return {"Software": SOFTWARE, **({} if command is None else {COMMENT: command})}
    drawn = None if command is None else f"{_DRAWN_BY}{command}"
    if form == "svg":
        return {"Creator": SOFTWARE, "Date": None, "Description": drawn}
    return {"Creator": SOFTWARE, "Producer": SOFTWARE, "CreationDate": None, "Subject": drawn}


def require_overwritable(out: Path, kind: SingleFile, *, inputs: Sequence[Path] = ()) -> Path:
    """Check, before anything is computed, that an output file is new, empty or of the same command.

    Args:
        out: File that is to be written.
        kind: Kind of file that the command writes.
        inputs: Files that are read; a folder does not protect the files in it.

    Returns:
        The path to write, with symbolic links resolved.

    Raises:
        AlreadyExists: `out` is a folder, no regular file, an input, not empty and not of `kind`, or
            one of the outputs that `manifest.json` beside it lists.
        NotFound: The folder to write it into does not exist.
    """
    file = Path(os.path.realpath(out))
    if file.is_dir():
        raise AlreadyExists(f"{out} is a folder; give the name of a file as --out")
    if not file.parent.is_dir():
        raise NotFound(f"{out.parent}: no such folder; create it, or choose another --out")
    for path in inputs:
        if path.exists() and file.exists() and path.samefile(file):
            raise AlreadyExists(f"{out} is an input of {kind.command}; choose another --out")
    if os.path.lexists(file):
        _require_ours(out, file, kind)
    return file


def _require_ours(out: Path, file: Path, kind: SingleFile) -> None:
    """Raise `AlreadyExists` unless an existing file is empty or has the marks of the command.

    Nor may it be an output that the manifest beside it lists.

    Args:
        out: The file as named, for the message.
        file: The file with links resolved.
        kind: Kind of file that the command writes.
    """
    if not file.is_file():
        raise AlreadyExists(f"{out} is not a regular file; choose another file with --out")
    with file.open("rb") as opened:
        head = opened.read(_SEARCHED)
        opened.seek(max(file.stat().st_size - _SEARCHED, 0))
        tail = opened.read(_SEARCHED)
    is_ours = any(
        head.startswith(begin) and (mark in head or mark in tail)
        for begin, mark in kind.marks.items()
    )
    if head and not is_ours:  # an empty file may be overwritten
        raise AlreadyExists(
            f"{out} was not made by {kind.command}; move it away, or choose another --out"
        )
    if file.name in listed_outputs(file.parent):
        raise AlreadyExists(
            f"{out} is part of the result in {file.parent} ({MANIFEST}); choose another --out"
        )
