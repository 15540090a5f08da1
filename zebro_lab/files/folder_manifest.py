# SPDX-License-Identifier: MIT
"""Read and check the manifests of result folders."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Final

from zebro_lab.files.documents import read_json_document, require_object
from zebro_lab.files.errors import DataError, NotFound, ZebroLabError
from zebro_lab.files.provenance import file_hash

MANIFEST: Final = "manifest.json"


def read_json_object(file: Path, *, of: str) -> dict[str, Any]:
    """Read a JSON file whose content must be an object; the file marks a kind of folder.

    Args:
        file: The file.
        of: Kind of folder that holds such a file, e.g. "walk folder"; part of the message of
            `NotFound`.

    Raises:
        NotFound: There is no such file.
        DataError: `read_json_document` cannot read the file, or its content is no object.
    """
    try:
        return require_object(read_json_document(file), file)
    except NotFound as error:
        within = such_folder_in(file.parent, file.name)
        raise NotFound(f"{file.parent} is not a {of}: {file.name} is missing{within}") from error


def such_folder_in(folder: Path, name: str) -> str:
    """Offer a folder that has a file of a name, directly in another, for an error message.

    Args:
        folder: Folder that was given in the place of one of those in it.
        name: Name of the file.

    Returns:
        A clause that begins with "; "; "" where no folder in it has such a file.
    """
    found = min(folder.glob(f"*/{name}"), default=None)
    return "" if found is None else f"; give one of the folders in it, such as {found.parent}"


def read_folder_manifest(
    file: Path, *, of: str, kinds: Collection[str], schema: int
) -> Mapping[str, Any]:
    """Read the manifest of a result folder, and check its kind and schema.

    Args:
        file: The manifest.
        of: Content of the folder, e.g. "walk"; part of the error message.
        kinds: Accepted values of the key `kind`.
        schema: Accepted value of the key `schema`.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not a JSON object, or its kind or schema is missing or another.
    """
    content = read_json_object(file, of=f"{of} folder")
    if content.get("kind") not in tuple(kinds):
        raise DataError(f"is not a manifest of a {of}: expected 'kind' {' or '.join(kinds)}, found "
                        f"{content.get('kind', 'none')}", file=file)  # fmt: skip
    if content.get("schema") != schema:
        raise DataError(
            f"has schema {content.get('schema', 'missing')}; this version of zebro-lab reads "
            f"schema {schema}: use the version that wrote the file",
            file=file,
        )
    return content


def listed_outputs(folder: Path) -> Mapping[str, object]:
    """Return the SHA-256 of each file that the manifest of a result folder lists, by its name.

    Empty without a readable manifest. Names with a folder, and that of the manifest, are left out.
    """
    try:
        listed = read_json_object(folder / MANIFEST, of="result folder").get("outputs")
    except ZebroLabError:
        return {}
    if not isinstance(listed, Mapping):
        return {}
    return {n: digest for n, digest in listed.items() if n == Path(n).name and n != MANIFEST}


def changed_output(file: Path) -> tuple[str, ...]:
    """Return one sentence if a file of a result folder is not as it was written; else empty.

    Nothing is said of a file that no readable manifest lists, or that is missing.
    """
    digest = listed_outputs(file.parent).get(file.name)
    if not isinstance(digest, str) or not file.is_file() or file_hash(file) == digest:
        return ()
    return (
        f"{file} was changed after it was written: its SHA-256 differs from that in {MANIFEST}; "
        "restore it, or run the command that writes it again",
    )


def lost_output(file: Path) -> tuple[str, ...]:
    """Return one sentence if a file that the manifest beside it lists is missing; else empty."""
    if file.exists() or file.name not in listed_outputs(file.parent):
        return ()
    return (f"{file}, which {MANIFEST} lists, is missing; restore it",)


def result_kind(folder: Path) -> str | None:
    """Return the kind of result that a folder holds; None without a readable manifest of a result.

    That has a text as `kind`, and the keys `schema` and `outputs`.
    """
    try:
        content = read_json_object(folder / MANIFEST, of="result folder")
    except ZebroLabError:
        return None
    kind = content.get("kind")
    ours = isinstance(kind, str) and {"schema", "outputs"} <= content.keys()
    return kind if ours else None
