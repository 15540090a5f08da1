# SPDX-License-Identifier: MIT
"""The modules of a checkout as syntax trees."""

import ast
import io
import subprocess
import tarfile
import tokenize
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeAlias

PACKAGES = ("zebro_lab", "rig", "tracking", "model")
Function: TypeAlias = ast.FunctionDef | ast.AsyncFunctionDef
_LAYOUT = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
           tokenize.ENDMARKER)  # fmt: skip


@dataclass(frozen=True)
class Module:
    """A module of one of the packages.

    Attributes:
        path: Its file, from the top of the checkout.
        text: What is in the file.
    """

    path: Path
    text: str

    @cached_property
    def tree(self) -> ast.Module:
        """The syntax tree."""
        return ast.parse(self.text)

    @property
    def name(self) -> str:
        """Dotted name, as it is imported."""
        parts = self.path.with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    @property
    def n_lines(self) -> int:
        """Number of lines of the file."""
        return len(self.text.splitlines())

    @cached_property
    def code_lines(self) -> frozenset[int]:
        """Numbers of the lines that hold code: no docstring, comment or blank line."""
        lines: set[int] = set()
        for token in tokenize.generate_tokens(io.StringIO(self.text).readline):
            if token.type not in _LAYOUT:
                lines.update(range(token.start[0], token.end[0] + 1))
        return frozenset(lines.difference(*(docstring_lines(node) for node in ast.walk(self.tree))))

    def functions(self) -> Iterator[Function]:
        """Yield every function and method, nested ones too."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield node


def docstring_lines(node: ast.AST) -> range:
    """Return the numbers of the lines of a string that is a statement, as a docstring is.

    That of a module, class or function, or of the constant or attribute above it.
    """
    if (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ):
        return range(node.lineno, (node.end_lineno or node.lineno) + 1)
    return range(0)


def read_modules(root: Path) -> dict[str, Module]:
    """Read the modules of the four packages of a checkout, by dotted name."""
    files = [file for package in PACKAGES for file in sorted((root / package).rglob("*.py"))]
    found = [Module(file.relative_to(root), file.read_text(encoding="utf-8")) for file in files]
    return {module.name: module for module in found}


@contextmanager
def open_checkout(place: str) -> Iterator[Path]:
    """Yield the folder of a checkout; a commit of this repository is unpacked for the while.

    Args:
        place: A folder, or what git understands as a commit.

    Raises:
        SystemExit: It is neither.
    """
    if Path(place).is_dir():
        yield Path(place)
        return
    archived = subprocess.run(
        ["git", "archive", place], cwd=Path(__file__).parent.parents[1], capture_output=True
    )
    if archived.returncode:
        raise SystemExit(f"{place} is neither a folder nor a commit: {archived.stderr.decode()}")
    with TemporaryDirectory() as folder, tarfile.open(fileobj=io.BytesIO(archived.stdout)) as tar:
        tar.extractall(folder, filter="data")
        yield Path(folder)
