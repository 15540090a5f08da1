# SPDX-License-Identifier: MIT
"""Options that say where independent tasks are computed."""

import os
from dataclasses import dataclass
from typing import Annotated, TypeAlias

from typer import Option

from zebro_lab.files.errors import SettingsError

SchedulerOption: TypeAlias = Annotated[
    str | None,
    Option(
        metavar="tcp://HOST:PORT",
        help="Dask scheduler whose workers compute independent tasks, instead of this machine's "
        "cores; tls://HOST:PORT outside a network of your own.",
    ),
]


@dataclass(frozen=True)
class WorkersRequest:
    """Options of the workers; results are the same wherever they are computed."""

    processes: Annotated[
        int | None,
        Option(min=1, help="Processes on this machine; default: one for each of its cores."),
    ] = None
    scheduler: SchedulerOption = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form, or with a number of processes."""
        require_address(self.scheduler)
        if self.scheduler is not None and self.processes is not None:
            raise SettingsError(
                "--processes are of this machine, and --scheduler's workers are started on theirs; "
                "leave one of them out",
                key="--processes",
            )


@dataclass(frozen=True)
class CoresRequest:
    """Options of the workers of a command whose work is often too small to start processes for.

    Results are the same wherever they are computed.
    """

    threads: Annotated[
        int | None,
        Option(min=1, help="Cores of this machine to use; default: all."),
    ] = None
    scheduler: SchedulerOption = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form."""
        require_address(self.scheduler)

    @property
    def cores(self) -> int:
        """Number of cores of this machine to use."""
        return self.threads or os.cpu_count() or 1


def require_address(scheduler: str | None) -> None:
    """Raise `SettingsError` for the address of a scheduler, if any, that has another form."""
    if scheduler is not None:
        from zebro_lab.workers.address import parse_address

        parse_address(scheduler)
