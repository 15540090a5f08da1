# SPDX-License-Identifier: MIT
"""`zebro-lab doctor`: check that this machine has what zebro-lab needs."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

Data = Annotated[Path, typer.Option(metavar="DIR", help="Folder that recordings are written to.")]


@request_command()
def doctor(data: Data = Path(), output: Output = TEXT) -> None:
    """Check packages, serial ports, CAN interfaces and disk; end with 1 if any is BROKEN."""
    from zebro_lab.recording.doctor import examine

    findings = list(examine(data))
    for finding in findings:
        output.say(f"{finding.state:<6}  {finding.what}: {finding.text}")
    broken = sum(finding.state == "BROKEN" for finding in findings)
    output.say(
        f"{broken} BROKEN, see above" if broken else "everything that zebro-lab needs is there"
    )
    content = {"findings": [asdict(finding) for finding in findings]}
    output.document("doctor", content, exit_code=int(broken > 0))
    if broken:
        raise typer.Exit(1)
