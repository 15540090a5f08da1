# SPDX-License-Identifier: MIT
"""Single files that a command makes: replaced where the file says that the command made it."""

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from zebro_lab.files.errors import AlreadyExists, NotFound, ZebroLabError
from zebro_lab.files.folder_manifest import read_json_object
from zebro_lab.files.result_folder import MANIFEST

_HEAD: Final = 1 << 16
"""Marks lie within so many first bytes."""
_PNG: Final = b"\x89PNG\r\n\x1a\n"
SOFTWARE: Final = "zebro-lab"
COMMENT: Final = "Comment"
"""PNG keyword under which a picture names the command that drew it."""


@dataclass(frozen=True)
class OwnFile:
    """A kind of file that one command makes.

    Attributes:
        command: The command, for a person.
        is_ours: Tells by the first bytes of a file whether the command made it.
    """

    command: str
    is_ours: Callable[[bytes], bool]


def html_page(command: str) -> OwnFile:
    """Return the mark of a page: zebro-lab as its generator."""
    return OwnFile(command, lambda head: b'<meta name="generator" content="zebro-lab ' in head)


def picture(command: str) -> OwnFile:
    """Return the mark of a PNG picture: its software, and the command as its comment.

    A picture of an earlier version names the software alone.
    """

    def is_ours(head: bytes) -> bool:
        texts = dict(_png_texts(head))
        return texts.get("Software") == SOFTWARE and texts.get(COMMENT, command) == command

    return OwnFile(command, is_ours)


def text_file(command: str, heading: str) -> OwnFile:
    """Return the mark of a text file: the line that it begins with."""
    return OwnFile(command, lambda head: head.startswith(heading.encode()))


def require_own(out: Path, kind: OwnFile, *, inputs: Sequence[Path] = ()) -> Path:
    """Refuse to write onto what the command did not make, before anything is computed.

    Args:
        out: File that is to be written.
        kind: What makes it.
        inputs: Files and folders that are read.

    Returns:
        The file itself, where `out` is a link to it.

    Raises:
        AlreadyExists: It is a folder, an input, part of a result, or not of the command.
        NotFound: Its folder does not exist.
    """
    file = Path(os.path.realpath(out))
    if file.is_dir():
        raise AlreadyExists(f"{out} is a folder; name a file as --out")
    if not file.parent.is_dir():
        raise NotFound(f"{out.parent}: no such folder; make it, or name another --out")
    for path in inputs:
        if path.exists() and file.exists() and path.samefile(file):
            raise AlreadyExists(f"{out} is read by {kind.command}; name another --out")
    if os.path.lexists(file):
        _require_ours(out, file, kind)
    return file


def _require_ours(out: Path, file: Path, kind: OwnFile) -> None:
    if not file.is_file():
        raise AlreadyExists(f"{out} is no regular file; name another --out")
    with file.open("rb") as opened:
        head = opened.read(_HEAD)
    if head and not kind.is_ours(head):  # an empty file is nobody's work
        raise AlreadyExists(
            f"{out} was not made by {kind.command}; move it away, or name another --out"
        )
    if file.name in _listed_beside(file):
        raise AlreadyExists(
            f"{out} belongs to the result in {file.parent}, see {MANIFEST}; name another --out"
        )


def _listed_beside(file: Path) -> Sequence[str]:
    """List the files of the result that a file lies in, if it lies in one."""
    try:
        manifest = read_json_object(file.parent / MANIFEST, of="result folder")
    except ZebroLabError:
        return ()
    outputs = manifest.get("outputs")
    return tuple(outputs) if isinstance(outputs, dict | list) else ()


def _png_texts(head: bytes) -> Iterator[tuple[str, str]]:
    """Yield keyword and text of the tEXt chunks at the beginning of a PNG."""
    if not head.startswith(_PNG):
        return
    at = len(_PNG)
    while at + 8 <= len(head):
        length, kind = int.from_bytes(head[at : at + 4], "big"), head[at + 4 : at + 8]
        if kind == b"tEXt":
            keyword, _, text = head[at + 8 : at + 8 + length].partition(b"\0")
            yield keyword.decode("latin-1"), text.decode("latin-1")
        at += 12 + length
