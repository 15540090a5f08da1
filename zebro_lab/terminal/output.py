# SPDX-License-Identifier: MIT
"""What a command prints: text, one JSON document, or nothing."""

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from zebro_lab.files.documents import json_text
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.stopping import STOPPED, StoppedBySignal
from zebro_lab.terminal.timely_output import say_in_time

if TYPE_CHECKING:
    from rich.console import Console

    from zebro_lab.terminal.progress import ProgressBar


@dataclass(frozen=True)
class Output:
    """Options of what a command prints."""

    as_json: Annotated[
        bool,
        typer.Option(
            "--json", help="Print the results as one JSON document; all else goes to stderr."
        ),
    ] = False
    quiet: Annotated[
        bool, typer.Option("--quiet", help="Print errors alone, and the document of --json.")
    ] = False

    @contextmanager
    def progress(self, *stopped: type[Exception]) -> "Iterator[ProgressBar]":
        """Show progress as `progress_bar` does, unless quiet; stop signals are heard either way.

        Args:
            stopped: Errors with which a stage ends that was asked to stop.

        Raises:
            Exit: The body ended with one of them, with exit code `STOPPED`; its message is said.
        """
        from zebro_lab.terminal.progress import progress_bar

        try:
            with progress_bar(quiet=self.quiet) as watcher:
                yield watcher
        except stopped as asked:
            say(str(asked), err=True)
            raise typer.Exit(STOPPED) from None

    def console(self) -> "Console":
        """Create the console for results as text: on stdout, or stderr beside a JSON document."""
        from rich.console import Console

        aside = self.quiet or self.as_json
        # Where the width is unknown, tables get one that they fit into.
        width = 120 if aside or not Console().is_terminal else None
        return Console(stderr=aside, quiet=self.quiet, highlight=False, width=width)

    def say(self, *lines: str) -> None:
        """Write lines of results where `console` writes."""
        for line in () if self.quiet else lines:
            say(line, err=self.as_json)

    def say_in_time(self, text: str) -> bool:
        """Write lines of results where `console` writes, with a timeout.

        Returns:
            Whether they were written, as of `zebro_lab.terminal.timely_output.say_in_time`; True if
            quiet.
        """
        return self.quiet or say_in_time(text, err=self.as_json)

    @contextmanager
    def asking(self) -> Iterator[None]:
        """Ask questions within, on stderr, where they disturb no document; also if quiet.

        Raises:
            SettingsError: Standard input has ended before a question was answered.
        """
        try:
            with redirect_stdout(sys.stderr):
                yield
        except StoppedBySignal:
            sys.stderr.write("\n")
            raise
        except typer.Abort:
            sys.stderr.write("\n")
            raise SettingsError(
                "standard input has ended before this question was answered; run the command at a "
                "terminal, or pass it all answers, one a line"
            ) from None

    def document(self, command: str, content: Mapping[str, Any], *, exit_code: int = 0) -> None:
        """Print the JSON document, if it is asked for; NaN and infinity become null.

        Args:
            command: The command, without `zebro-lab`.
            content: Results; keys end in the unit.
            exit_code: Exit code with which the command is about to end.
        """
        if not self.as_json:
            return
        typer.echo(json_text({"command": command, "exit_code": exit_code, **content}))


TEXT: Final = Output()
"""Results as text, which is the default."""
