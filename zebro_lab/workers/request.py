# SPDX-License-Identifier: MIT
"""Options that say where independent tasks are computed."""

from dataclasses import dataclass
from typing import Annotated

from typer import Option

from zebro_lab.files.errors import SettingsError


@dataclass(frozen=True)
class WorkersRequest:
    """Options of the workers; results are the same wherever they are computed."""

    processes: Annotated[
        int | None,
        Option(min=1, help="Processes on this machine; default: one for each of its cores."),
    ] = None
    scheduler: Annotated[
        str | None,
        Option(
            metavar="tcp://HOST:PORT",
            help="Dask scheduler whose workers compute, instead of this machine; tls://HOST:PORT "
            "outside a network of your own.",
        ),
    ] = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form, or with a number of processes."""
        if self.scheduler is None:
            return
        from zebro_lab.workers.address import parse_address

        parse_address(self.scheduler)
        if self.processes is not None:
            raise SettingsError(
                "--processes are of this machine, and --scheduler's workers are started on theirs; "
                "leave one of them out",
                key="--processes",
            )
