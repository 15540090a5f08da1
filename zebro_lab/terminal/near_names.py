# SPDX-License-Identifier: MIT
"""Offer the command or option that a misspelt one means, and no other, as messages do elsewhere."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

from model.similar_name import similar_name
from zebro_lab.terminal.removed import replacement


@contextmanager
def near_option(path: str, known: Collection[str]) -> Iterator[None]:
    """Reword the error for an unknown option: "No such option: --speeed. Did you mean …?".

    Args:
        path: Command that was typed, as `zebro-lab walk`.
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
            _offer(unknown, path, unknown.option_name, known)
        raise


@contextmanager
def near_command(path: str, name: str, known: Collection[str]) -> Iterator[None]:
    """Reword the error for an unknown command: "No such command 'walkk'. Did you mean 'walk'?".

    Args:
        path: Group of commands that was typed, as `zebro-lab rig`.
        name: Command that was given.
        known: All commands of the group.

    Raises:
        Exception: As raised in the body, reworded if the command is unknown.
    """
    try:
        yield
    except Exception as error:
        if name not in known:
            _offer(error, path, name, known)
        raise


def _offer(error: Any, path: str, name: str, known: Collection[str]) -> None:
    """Add to the message what replaced a removed name, or else the known name that it resembles."""
    near = similar_name(name, known)
    advice = replacement(path, name) or (f"Did you mean '{near}'?" if near else None)
    if hasattr(error, "message") and advice:
        error.message = f"{error.message.rstrip('.')}. {advice}"
