# SPDX-License-Identifier: MIT
"""Offer the command or option that a misspelt one means, and no other, as messages do elsewhere."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

from model.similar_name import similar_name


@contextmanager
def near_option(known: Collection[str]) -> Iterator[None]:
    """Reword the error for an unknown option: "No such option: --speeed. Did you mean …?".

    Args:
        known: All options of the command.

    Raises:
        Exception: As raised in the body, reworded if it is about an unknown option.
    """
    try:
        yield
    except Exception as error:
        unknown: Any = error
        if hasattr(unknown, "possibilities"):  # Typer's own are other options as well
            unknown.possibilities = None
            _offer(unknown, unknown.option_name, known)
        raise


@contextmanager
def near_command(name: str, known: Collection[str]) -> Iterator[None]:
    """Reword the error for an unknown command: "No such command 'walkk'. Did you mean 'walk'?".

    Args:
        name: Command that was given.
        known: All commands of the group.

    Raises:
        Exception: As raised in the body, reworded if the command is unknown.
    """
    try:
        yield
    except Exception as error:
        if name not in known:
            _offer(error, name, known)
        raise


def _offer(error: Any, name: str, known: Collection[str]) -> None:
    near = similar_name(name, known)
    if near is not None and hasattr(error, "message"):
        error.message = f"{error.message.rstrip('.')}. Did you mean '{near}'?"
