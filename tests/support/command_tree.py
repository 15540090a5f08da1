# SPDX-License-Identifier: MIT
"""The tree of commands, of which tests are generated."""

from collections.abc import Iterator
from typing import Any, Final, NamedTuple

from typer.main import get_command

from zebro_lab.main import app, slip_app


class Found(NamedTuple):
    """A command in the tree: the words that call it, and Typer's object."""

    words: tuple[str, ...]
    command: Any


def commands(of: Any, *words: str) -> Iterator[Found]:
    """Yield a command and all commands below it."""
    yield Found(words, of)
    for name, inner in getattr(of, "commands", {}).items():
        yield from commands(inner, *words, name)


def named(found: Found) -> str:
    """Return the words of a command as one text."""
    return " ".join(found.words)


ROOTS: Final = {"zebro-lab": get_command(app), "calibrate-slip": get_command(slip_app)}
TREE: Final = [found for name, root in ROOTS.items() for found in commands(root, name)]
LEAVES: Final = [found for found in TREE if not hasattr(found.command, "commands")]
"""The commands that are no groups of commands."""
