# SPDX-License-Identifier: MIT
"""What people and programs may say to a running experiment, from any thread."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from rig.errors import PartFailed, ProtocolError
from rig.safety import StopCategory, StopSwitch

STOPS: Final = {category.name.lower(): category for category in StopCategory}
COMMANDS: Final = ("pause", "resume", "confirm", "note TEXT", *STOPS, "status")
LONGEST_NOTE: Final = 2000


@dataclass(frozen=True)
class Note:
    """Something to be kept in the log.

    Attributes:
        kind: `note`, or the command that was given.
        text: What was said.
    """

    kind: str
    text: str


class Control:
    """Mailbox of a run; the run looks into it at every sample.

    Attributes:
        stop: Where stops are asked for.
        status: One line on where the run is, for whoever asks.
        paused: Whether the run is to hold after the point it is at.
        failure: The first part of the run that failed; None while all work.
    """

    def __init__(self) -> None:
        self.stop = StopSwitch()
        self.status = "not started"
        self.paused = False
        self.failure: PartFailed | None = None
        self._confirmed = False
        self._notes: deque[Note] = deque()

    def obey(self, line: str, *, who: str) -> str:
        """Do what a line of text says.

        Args:
            line: One of `COMMANDS`.
            who: Who said so, for the log.

        Returns:
            What to answer.

        Raises:
            ProtocolError: There is no such command.
        """
        command, _, text = line.strip().partition(" ")
        if command == "status":
            return self.status
        if command in STOPS:
            self.stop.request(STOPS[command], storable_note(text) or f"asked for by {who}")
        elif command == "note" and text:
            self._notes.append(Note("note", f"{who}: {storable_note(text)}"))
        elif command == "pause":
            self.pause()
        elif command == "resume":
            self.resume()
        elif command == "confirm":
            self.confirm()
        else:
            raise ProtocolError(f"found '{line.strip()[:80]}'; expected {', '.join(COMMANDS)}")
        return "done"

    def fail(self, part: str, error: BaseException) -> None:
        """Report that a part of the run failed; a safe stop follows, and the run is an error.

        Args:
            part: Name of the part: a thread, the keyboard.
            error: What it raised.
        """
        failure = PartFailed(part, error)
        if self.failure is None:
            self.failure = failure
        self.stop.request(StopCategory.SAFE, str(failure))

    def pause(self) -> None:
        """Hold after the point that is being measured."""
        self.paused = True
        self._notes.append(Note("pause", "asked for"))

    def resume(self) -> None:
        """Go on after a pause or a soft stop; harder stops stay."""
        self.paused = False
        self.stop.release()
        self._notes.append(Note("resume", "asked for"))

    def confirm(self) -> None:
        """Say that what a prompt asked for is done."""
        self._confirmed = True

    def take_confirmation(self) -> bool:
        """Return whether a prompt was confirmed since it was last asked."""
        confirmed, self._confirmed = self._confirmed, False
        return confirmed

    def take_notes(self) -> Iterator[Note]:
        """Hand on what is to be kept in the log, each once."""
        while self._notes:
            yield self._notes.popleft()


def storable_note(text: str) -> str:
    r"""Return a text, no longer than a note may be, that every file and log can encode.

    What is no character, such as bytes of a foreign encoding, becomes an escape.

    >>> storable_note("caf\udce9")
    'caf\\udce9'
    """
    return text[:LONGEST_NOTE].encode("utf-8", "backslashreplace").decode("utf-8")
