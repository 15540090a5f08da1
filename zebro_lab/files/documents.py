# SPDX-License-Identifier: MIT
"""Read TOML and JSON files with limits on size; format JSON."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from model.toml_table import MOST_BYTES, parse_toml
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.opening import Fault, parsing, read_bytes, read_text

MOST_JSON: Final = 8 << 20
"""Largest JSON file that is read: the manifest of fifty thousand photographs [bytes]."""


def read_toml_document(
    path: Path, *, advice: str = "", remedy: str = "", fault: Fault = SettingsError
) -> dict[str, Any]:
    """Read a TOML file.

    Args:
        path: The file.
        advice: What to do if the file does not exist; part of the error message.
        remedy: What to do if the file is not TOML; part of the error message.
        fault: Type of error to raise if the file exists but cannot be read.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file is not regular, cannot be opened, is larger than `MOST_BYTES` of
            `model.toml_table`, or is not TOML (`DataError` if `fault` is that type).
    """
    data = read_bytes(path, most=MOST_BYTES, advice=advice, fault=fault)
    with parsing(path, "cannot be read as TOML", advice=remedy, fault=fault):
        return parse_toml(data)


def read_json_document(path: Path, *, advice: str = "") -> Any:
    """Read a JSON file.

    Args:
        path: The file.
        advice: What to do if the file does not exist; part of the error message.

    Returns:
        The parsed content: a dict, list, string, number, bool or None.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, cannot be opened, is larger than `MOST_JSON`, not UTF-8
            or not JSON, or is nested too deeply.
    """
    text = read_text(path, most=MOST_JSON, advice=advice)
    with parsing(path, "cannot be read as JSON", advice="restore or create the file again"):
        return json.loads(text)


def require_object(content: object, path: Path) -> dict[str, Any]:
    """Check that the content of a JSON file is an object (a dict), and return it.

    Args:
        content: Parsed content.
        path: The file, for the error message.

    Raises:
        DataError: The content is not an object but a list, number, string, bool or null.
    """
    if not isinstance(content, dict):
        raise DataError("is not a JSON object: expected named values in braces", file=path)
    return content


def json_text(document: object) -> str:
    r"""Format a document as JSON of several lines.

    Args:
        document: Mappings, lists, tuples and values, also arrays and numbers of NumPy and paths.
            NaN and infinity become null; bytes of file names that are not UTF-8, which Python holds
            as lone surrogates, become escapes such as `\udce9`.

    >>> print(json_text({"label": "a", "sd": float("nan")}))
    {
      "label": "a",
      "sd": null
    }
    """
    return json.dumps(_plain(document), indent=2, allow_nan=False)


def _plain(value: Any) -> Any:
    """Return a value as JSON can hold it, nested ones too, as `json_text` says."""
    if isinstance(value, str | Path):
        return str(value).encode("utf-8", "backslashreplace").decode("utf-8")
    if isinstance(value, Mapping):
        return {_plain(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
