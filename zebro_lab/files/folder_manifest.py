# SPDX-License-Identifier: MIT
"""Manifests of the folders that commands write: read, and refused where they are others."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from zebro_lab.files.documents import read_json_document, require_object
from zebro_lab.files.errors import DataError, NotFound


def read_json_object(file: Path, *, of: str) -> dict[str, Any]:
    """Read a folder's JSON file.

    Args:
        file: The file.
        of: What the folder should be, as "walk folder".

    Raises:
        NotFound: There is none.
        DataError: It is damaged, or no JSON object.
    """
    try:
        return require_object(read_json_document(file), file)
    except NotFound as error:
        raise NotFound(f"{file.parent} is no {of}: it has no {file.name}") from error


def read_folder_manifest(
    file: Path, *, of: str, kinds: Collection[str], schema: int
) -> Mapping[str, Any]:
    """Read the manifest of a folder that a command wrote.

    Args:
        file: The manifest.
        of: What the folder holds, as "walk".
        kinds: What its `kind` may be.
        schema: The version that is read.

    Raises:
        NotFound: There is none.
        DataError: It is damaged, of another schema, or that of another command.
    """
    content = read_json_object(file, of=f"{of} folder")
    if content.get("kind") not in tuple(kinds):
        raise DataError(f"is not of a {of}; expected kind {' or '.join(kinds)}", file=file)
    if content.get("schema") != schema:
        raise DataError(
            f"has schema {content.get('schema')}, this version reads {schema}; update zebro-lab",
            file=file,
        )
    return content
