# SPDX-License-Identifier: MIT
"""Thread-safe mailbox of commands to a running experiment: pause, confirm, stop, notes."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from rig.errors import PartFailed, ProtocolError
from rig.safety import StopCategory, StopSwitch

STOPS: Final = {category.name.lower(): category for category in StopCategory}
COMMANDS: Final = ("pause", "resume", "confirm", "note TEXT", *STOPS, "status")
LONGEST_NOTE: Final = 2000
"""Largest length of a note or a command [characters]."""


@dataclass(frozen=True)
class Note:
    """Entry for the log of a run.

    Attributes:
        kind: `note`, `pause` or `resume`.
        text: Origin and text of a note; `requested` for a command.
    """

    kind: str
    text: str


class Control:
    """Mailbox of commands to a run, which polls it continuously.

    Attributes:
        stop: Switch that collects requests to stop.
        status: Progress, prompt or state of the run in one line.
        paused: Whether the run is to hold before its next step, until `resume`.
        failure: Error of the first part of the run that failed; None without a failure.
    """

    def __init__(self) -> None:
        self.stop = StopSwitch()
        self.status = "not started"
        self.paused = False
        self.failure: PartFailed | None = None
        self._confirmed = False
        self._notes: deque[Note] = deque()

    def execute(self, line: str, *, who: str) -> str:
        """Execute a command given as a line of text.

        Args:
            line: One of `COMMANDS`; a reason may follow the name of a stop. Reasons and notes are
                truncated to `LONGEST_NOTE`; text behind other commands is ignored.
            who: Origin of the command, for the log of notes and of stops without a reason.

        Returns:
            The status for the command `status`, else `done`.

        Raises:
            ProtocolError: There is no such command, or a note has no text.
        """
        command, _, text = line.strip().partition(" ")
        actions = {"pause": self.pause, "resume": self.resume, "confirm": self.confirm}
        if command == "status":
            return self.status
        if command in STOPS:
            self.stop.request(STOPS[command], storable_note(text) or f"requested by {who}")
        elif command == "note" and text:
            self._notes.append(Note("note", f"{who}: {storable_note(text)}"))
        elif command in actions:
            actions[command]()
        else:
            raise ProtocolError(
                f"cannot execute '{line.strip()[:80]}'; expected {', '.join(COMMANDS)}"
            )
        return "done"

    def fail(self, part: str, error: BaseException) -> None:
        """Request a safe stop because a part of the run failed; keep the first in `failure`.

        Args:
            part: Name of the part, such as a thread or the keyboard.
            error: Exception that the part raised.
        """
        failure = PartFailed(part, error)
        if self.failure is None:
            self.failure = failure
        self.stop.request(StopCategory.SAFE, str(failure))

    def pause(self) -> None:
        """Request a hold before the next step, after all attempts at the present point; logged."""
        self.paused = True
        self._notes.append(Note("pause", "requested"))

    def resume(self) -> None:
        """Clear a pause and soft stops, so that the run resumes; harder stops stay. Logged."""
        self.paused = False
        self.stop.release()
        self._notes.append(Note("resume", "requested"))

    def confirm(self) -> None:
        """Store the confirmation that the action of a prompt is done, for `take_confirmation`."""
        self._confirmed = True

    def take_confirmation(self) -> bool:
        """Return whether `confirm` was called since the last call of this method."""
        confirmed, self._confirmed = self._confirmed, False
        return confirmed

    def take_notes(self) -> Iterator[Note]:
        """Remove and yield the entries for the log."""
        while self._notes:
            yield self._notes.popleft()


def storable_note(text: str) -> str:
    r"""Truncate a text to `LONGEST_NOTE` characters, and escape what UTF-8 cannot encode.

    Unpaired surrogates, such as bytes of another encoding, become escape sequences.

    >>> storable_note("caf\udce9")
    'caf\\udce9'
    """
    return text[:LONGEST_NOTE].encode("utf-8", "backslashreplace").decode("utf-8")
