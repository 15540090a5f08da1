# SPDX-License-Identifier: MIT
"""Result folders: written atomically with a manifest, and replaced only by the same command.

`manifest.json` has the kind of the result and the hash of each file that the command wrote. All
other files in the folder belong to the user: they are kept when the result is replaced, and a
result that would overwrite one raises an error.
"""

import atexit
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from rig.exclusive import Exclusive
from zebro_lab.files.atomic import draft_folder, nearest_folder, sync_files
from zebro_lab.files.documents import json_text
from zebro_lab.files.errors import AlreadyExists, NotWritten, ZebroLabError
from zebro_lab.files.folder_manifest import MANIFEST, listed_outputs, read_json_object
from zebro_lab.files.provenance import file_hash, software, software_commit
from zebro_lab.files.replacement import previous_of, recover, replace_folder

_GLOB: Final = "*"
_claims: Final[dict[Path, Exclusive]] = {}
"""Locks of the result folders that this process is about to write."""
atexit.register(lambda: [claim.release() for claim in _claims.values()])


@dataclass(frozen=True)
class ResultKind:
    """Kind of result folder that a command writes.

    Attributes:
        kind: Name of the kind, in the manifest under `kind`.
        command: Command that writes the folder, as shown in messages.
        names: Names, or patterns with `*`, of the files that the command may write, besides the
            manifest.
        schema: Version of the format, in the manifest under `schema`.
        inside: Results in subfolders that a new result invalidates, so that they are removed with
            the old one: kind by name of the subfolder.
    """

    kind: str
    command: str
    names: tuple[str, ...]
    schema: int = 1
    inside: Mapping[str, str] = field(default_factory=dict)


def require_replaceable(out: Path, kind: ResultKind, *, inputs: Sequence[Path] = ()) -> None:
    """Check that a result folder can be created or replaced, before anything is computed.

    An interrupted replacement of the folder, or of a result inside it, is first finished or undone.
    No other process can then replace the folder until this one has written it, or ends.

    Args:
        out: Folder that is to be written.
        kind: Kind of result to write; names with `*` are not checked here.
        inputs: Files and folders that are read.

    Raises:
        AlreadyExists: `out` is a file or below one, a broken link or behind one, the working folder
            or above it, or the result of another command; its manifest cannot be read; a file that
            the manifest lists was changed; a file to be written exists and is not listed;
            `.out.previous` cannot be removed; `out` is an input, or has one among the files to be
            replaced; or another process is replacing it.
        InUse: Another process has called this function, and has not written the folder yet.
        NotWritten: The nearest existing parent folder, or the folder itself, cannot be written to.
        DataError: A replacement was interrupted, and what is left of it cannot be renamed.
    """
    software_commit()  # of the code that computes, not of what is committed meanwhile
    folder = real_place(out)
    recover(folder)
    if os.path.lexists(previous_of(folder)):
        raise AlreadyExists(
            f"{previous_of(folder)}, which an interrupted replacement of {out} left, cannot be "
            "removed; remove it, or choose another folder with --out"
        )
    _require_ground(out)
    if os.path.lexists(folder) and not folder.is_dir():
        raise AlreadyExists(f"{out} is a file; give the name of a folder as --out")
    _require_not_inside(out, folder)
    for each in kind.inside:
        recover(folder / each)
    owned = _owned(folder, kind)
    fixed = [name for name in (*kind.names, MANIFEST) if _GLOB not in name]
    _require_free(folder, fixed, kind, owned)
    for path in inputs:
        _require_kept(out, folder, path, {*fixed, *owned})
    ground = folder.parent if folder.parent.is_dir() else nearest_folder(folder)
    for place in (ground, *([folder] if folder.is_dir() else ())):
        if not os.access(place, os.W_OK | os.X_OK):
            raise NotWritten(f"{place} is not writable; choose another folder with --out")
    name, what = f"result:{folder}", f"{out} as --out"
    _claims.setdefault(folder, Exclusive(name, what=what, shared=True)).take()


@contextmanager
def result_folder(out: Path, kind: ResultKind, *, content: Mapping[str, object]) -> Iterator[Path]:
    """Write a result folder atomically; after an exception the earlier result is unchanged.

    The manifest is written last: schema, kind, content, hashes of the files (not of those in
    subfolders), and software. All files of the earlier result are removed, also those in
    `kind.inside`; the user's other files are kept.

    Args:
        out: Folder to create or to replace; missing parents are created.
        kind: Kind of result to write.
        content: Further keys of the manifest, NaN and infinity as null; read when the body has
            ended.

    Yields:
        The draft folder to write into.

    Raises:
        AlreadyExists: As in `require_replaceable`, now or at the end; then also a user's file has
            the name of any file that was written.
        NotWritten: The parent folder, the draft, its files or the manifest cannot be written, or
            the draft cannot be moved to `out`.
        DataError, InUse: As in `require_replaceable`.
    """
    require_replaceable(out, kind)
    folder = real_place(out)
    with _claims.pop(folder), writing(out), draft_folder(folder) as draft:
        yield draft
        document = {
            "schema": kind.schema,
            "kind": kind.kind,
            **content,
            "outputs": {p.name: file_hash(p) for p in sorted(draft.iterdir()) if p.is_file()},
            "software": software(),
        }
        (draft / MANIFEST).write_text(json_text(document) + "\n", encoding="utf-8")
        sync_files(draft)
        written = [path.name for path in draft.iterdir()]

        def owned() -> Collection[str]:
            """Return the earlier result's files, once no other file has a name of the new one."""
            names = _owned(folder, kind)
            _require_free(folder, written, kind, names)
            return names

        replace_folder(folder, draft, owned=owned)


def real_place(path: Path) -> Path:
    """Return the absolute path with links resolved, so that a link's target is replaced."""
    return Path(os.path.realpath(path))


@contextmanager
def writing(out: Path) -> Iterator[None]:
    """Convert an `OSError` of the body, which writes `out`, into a one-line error.

    Raises:
        NotWritten: The body raised an `OSError` that is not a `ZebroLabError`.
    """
    try:
        yield
    except OSError as error:
        if isinstance(error, ZebroLabError):
            raise
        raise NotWritten(
            f"{out} cannot be written ({error.strerror or error}); choose another folder with --out"
        ) from error


def _require_ground(out: Path) -> None:
    """Raise `AlreadyExists` if a folder would be below a file or behind a broken link."""
    for place in (out, *out.parents):
        if place.is_symlink() and not place.exists():
            raise AlreadyExists(f"{place} is a broken link; choose another folder with --out")
        if place != out and place.exists() and not place.is_dir():
            raise AlreadyExists(f"{place} is a file, not a folder; name a folder")


def _require_not_inside(out: Path, folder: Path) -> None:
    """Raise `AlreadyExists` if the folder to replace is the working directory or above it."""
    try:
        here = Path.cwd()
    except OSError:  # it was removed
        return
    if folder == here or folder in here.parents:
        raise AlreadyExists(
            f"{out} is the working folder or contains it, and cannot be replaced; give a new "
            "folder in it as --out"
        )


def _owned(folder: Path, kind: ResultKind) -> frozenset[str]:
    """List the files that the same command wrote earlier and that exist, relative to the folder.

    They include the manifest, without which the list is empty, and the results in `kind.inside`.

    Raises:
        AlreadyExists: The manifest cannot be read or has another kind, or a listed file changed.
    """
    if not os.path.lexists(folder / MANIFEST):
        return frozenset()
    manifest = _manifest_of(folder)
    if manifest.get("kind") != kind.kind:
        raise AlreadyExists(
            f"{folder} holds the result of another command (kind '{manifest.get('kind')}'), which "
            f"{kind.command} does not replace; choose another folder with --out"
        )
    names = {MANIFEST}
    for name, digest in listed_outputs(folder).items():
        if not (folder / name).is_file():
            continue
        if file_hash(folder / name) != digest:
            raise AlreadyExists(
                f"{folder / name} was changed after {kind.command} wrote it and is not replaced; "
                "move that file away, or choose another folder with --out"
            )
        names.add(name)
    inner = (f"{sub}/{n}" for sub, each in kind.inside.items() for n in _void(folder / sub, each))
    return frozenset((*names, *inner))


def _void(folder: Path, kind: str) -> frozenset[str]:
    """List the files of an invalidated result of a kind in a subfolder, relative to the subfolder.

    Empty if one of them was changed, or if the subfolder has no result of this kind.
    """
    try:
        return _owned(folder, ResultKind(kind, kind, ()))
    except AlreadyExists:
        return frozenset()


def _manifest_of(folder: Path) -> Mapping[str, Any]:
    """Read the manifest of a result folder; raise `AlreadyExists` if it cannot be read."""
    try:
        return read_json_object(folder / MANIFEST, of="result folder")
    except ZebroLabError as error:
        raise AlreadyExists(
            f"{folder} is not replaced, because its manifest cannot be read ({error}); move the "
            "folder away, or choose another folder with --out"
        ) from error


def _require_free(
    folder: Path, names: Collection[str], kind: ResultKind, owned: Collection[str]
) -> None:
    """Raise `AlreadyExists` if one of the names exists in the folder and is not in `owned`."""
    for name in names:
        if name not in owned and os.path.lexists(folder / name):
            raise AlreadyExists(
                f"{folder / name} exists and is not replaced, because no {MANIFEST} shows that "
                f"{kind.command} wrote it; move it away, or choose another folder with --out"
            )


def _require_kept(out: Path, folder: Path, path: Path, replaced: Collection[str]) -> None:
    """Raise `AlreadyExists` if an input, at `path`, is the folder, or is or holds what it loses.

    Args:
        out: The folder as it was given, for the message.
        folder: Its real place.
        path: The input, a file or folder.
        replaced: Files and subfolders that the folder loses, relative to it.
    """
    place = real_place(path)
    lost = [folder / name for name in replaced]
    inside = place.is_relative_to(folder) and any(
        place.is_relative_to(each) or each.is_relative_to(place) for each in lost
    )
    if place == folder or inside:
        raise AlreadyExists(
            f"{out} as --out would replace {path}, which this command reads; choose another --out"
        )
