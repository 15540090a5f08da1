# SPDX-License-Identifier: MIT
"""Text files are UTF-8 whatever the locale: every call that reads or writes text names it."""

import ast
from pathlib import Path

import pytest

PACKAGES = ("model", "rig", "tracking", "zebro_lab")
ROOT = Path(__file__).parents[1]


def unnamed(text: str) -> list[int]:
    """Return the lines of calls of `read_text` and `write_text` that leave the encoding open."""
    return [
        node.lineno
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr in {"read_text", "write_text"}
        and "encoding" not in {each.arg for each in node.keywords}
    ]


@pytest.mark.parametrize("package", PACKAGES)
def test_text_is_read_and_written_as_utf_8(package):
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    found = {str(file): unnamed(file.read_text(encoding="utf-8")) for file in files}
    assert {file: lines for file, lines in found.items() if lines} == {}


def test_a_call_without_an_encoding_is_found():
    assert unnamed("file.write_text(\n    'a'\n)\nfile.read_text(encoding='utf-8')") == [1]
