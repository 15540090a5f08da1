# SPDX-License-Identifier: MIT
"""Files and folders that appear finished or not at all."""

import os
import secrets
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from zebro_lab.errors import AlreadyExists


def atomic_write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write a file so that a reader sees the old one or the whole new one.

    Args:
        path: File to write; its folder must exist.
        data: Its content.

    Returns:
        The path written.
    """
    target = Path(path)
    draft = target.with_name(_draft_name(target))
    try:
        with draft.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)
    return target


def atomic_write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write a UTF-8 text file as `atomic_write_bytes` does; line ends stay as they are."""
    return atomic_write_bytes(path, text.encode())


@contextmanager
def atomic_folder(
    target: str | os.PathLike[str], *, replaces: Sequence[str] = (), marker: str | None = None
) -> Iterator[Path]:
    """Fill a folder so that it appears finished or, after any exception, not at all.

    The body writes into a hidden folder beside the target. A target that does not exist yet
    appears in one step. Into one that exists the files are moved one by one: those of an earlier
    run that the body did not write again are removed, foreign files are left alone, and what
    was there stays as it was when the body fails.

    Args:
        target: Folder to make or to renew; missing parents are made.
        replaces: Glob patterns, relative to the folder, of what an earlier run may have left.
        marker: File whose presence tells readers that the folder is whole; taken away before
            the first and put in place after the last of the others.

    Yields:
        Folder to write into, empty.

    Raises:
        AlreadyExists: The target is a file.
    """
    folder = Path(target).absolute()
    if folder.exists() and not folder.is_dir():
        raise AlreadyExists(f"{target} is a file where a folder is to be written; name another")
    # Drafts lie in the nearest folder that exists: same file system, and no parent to clean up.
    ground = next(parent for parent in folder.parents if parent.is_dir())
    draft = ground / _draft_name(folder)
    draft.mkdir()
    try:
        yield draft
        _sync(draft)
        if folder.exists():
            _renew(folder, draft, replaces, marker)
        else:
            folder.parent.mkdir(parents=True, exist_ok=True)
            draft.replace(folder)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _draft_name(path: Path) -> str:
    return f".{path.name}.{secrets.token_hex(4)}.part"


def _sync(folder: Path) -> None:
    for path in folder.rglob("*"):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())


def _renew(folder: Path, draft: Path, replaces: Sequence[str], marker: str | None) -> None:
    written = sorted(path.relative_to(draft) for path in draft.rglob("*") if path.is_file())
    if marker is not None:
        (folder / marker).unlink(missing_ok=True)
        written.sort(key=lambda name: name == Path(marker))
    stale = {path for pattern in replaces for path in folder.glob(pattern) if path.is_file()}
    for path in stale - {folder / name for name in written}:
        path.unlink()
    for name in written:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (draft / name).replace(folder / name)
