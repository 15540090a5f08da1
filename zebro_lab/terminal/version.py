# SPDX-License-Identifier: MIT
"""The option `--version`: version and commit of the software."""

from importlib.metadata import version
from typing import Annotated, TypeAlias

import typer

from zebro_lab.files.provenance import software_commit


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"zebro-lab {version('zebro-lab')}, commit {software_commit()}")
        raise typer.Exit


Version: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--version",
        callback=_print_version,
        is_eager=True,
        help="Print version and commit of the software, and exit.",
    ),
]
