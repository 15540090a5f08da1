# SPDX-License-Identifier: MIT
"""`zebro-lab doctor`: check that this machine has what zebro-lab needs."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab doctor

zebro-lab doctor --data /mnt/recordings

Exit code 1 if anything is BROKEN. A note concerns only users of the device or program it names.
"""

Data = Annotated[Path, typer.Option(metavar="DIR", help="Folder that recordings are written to.")]


@request_command()
def doctor(data: Data = Path(), output: Output = TEXT) -> None:
    """Check versions, packages, serial ports, CAN interfaces, disk and optional programs."""
    from zebro_lab.recording.doctor.finding import Grade
    from zebro_lab.recording.doctor.stage import examine

    broken, findings = 0, []
    for finding in examine(data):
        broken += finding.state is Grade.BROKEN
        findings.append(asdict(finding))
        output.say(f"{finding.state:<6}  {finding.what}: {finding.text}")
    output.say(
        f"{broken} BROKEN, see above" if broken else "everything that zebro-lab needs is there"
    )
    output.document("doctor", {"findings": findings}, exit_code=int(broken > 0))
    if broken:
        raise typer.Exit(1)
