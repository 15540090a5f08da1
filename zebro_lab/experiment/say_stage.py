# SPDX-License-Identifier: MIT
"""Command an experiment that another process runs; imports little, for a stop must not wait."""

from pathlib import Path
from typing import Final

from rig.errors import LinkError, RigError
from rig.experiment.control import storable_note
from rig.experiment.control_server import send_command
from zebro_lab.experiment.latch import LATCH_FILE, EmergencyLatch
from zebro_lab.files.documents import read_json_document, require_object
from zebro_lab.files.errors import DataError, ZebroLabError

CONTROL_FILE: Final = "control.json"
EMERGENCY: Final = "emergency"
LONGEST_REASON: Final = 256
"""Largest length of the reason of an emergency stop; the rest is left out [characters]."""


def is_emergency(command: str) -> bool:
    """Return whether a command is an emergency stop, with whatever text."""
    return command.lower().split()[:1] == [EMERGENCY]


def command_run(data: Path, command: str) -> str:
    """Send a command to the experiment that runs in a folder, and return the reply.

    An emergency stop, with whatever text, is also latched on disk first, where the experiment looks
    for it: that way needs no socket.

    Args:
        data: Folder of the experiment.
        command: One of the commands of `rig.experiment.control`.

    Raises:
        NotFound: No experiment runs in the folder.
        DataError: The file with the address of the control socket is damaged.
        RigError: The experiment does not answer, or rejects the command; or an emergency stop
            reached it in neither way.
    """
    if is_emergency(command):
        words = storable_note(command).split()
        return _stop_at_once(data, " ".join(words[1:])[:LONGEST_REASON])
    return send_command(*_address(data), command)


def _stop_at_once(data: Path, reason: str) -> str:
    """Latch an emergency stop on disk, then send it; return which way was open, and which not.

    Raises:
        LinkError: Neither was.
    """
    ways = {
        LATCH_FILE: lambda: EmergencyLatch(data).latch(reason or "requested by rig say"),
        CONTROL_FILE: lambda: send_command(*_address(data), f"{EMERGENCY} {reason}"),
    }
    done, failed = [], []
    for file, stop in ways.items():
        try:
            stop()
            done.append(file)
        except (OSError, RigError, ZebroLabError) as error:
            failed.append(f"not by {file}: {error}")
    if not done:
        raise LinkError(f"no emergency stop, use that of the rig: {'; '.join(failed)}")
    return "; ".join([f"emergency stop by {' and '.join(done)} in {data}", *failed])


def _address(data: Path) -> tuple[int, str]:
    """Read port and token of a running experiment's control socket from its JSON file.

    Raises:
        NotFound: There is no such file.
        DataError: The file is damaged, or port or token is missing or invalid.
    """
    file = data / CONTROL_FILE
    advice = "no experiment is running here; start one, or give its --data"
    content = require_object(read_json_document(file, advice=advice), file)
    port, token = content.get("port"), content.get("token")
    if type(port) is not int or not 0 < port < 1 << 16 or not isinstance(token, str):
        problem = "holds no valid port and token; use the keys of the experiment's terminal"
        raise DataError(problem, file=file)
    return port, token
