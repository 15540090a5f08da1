# SPDX-License-Identifier: MIT
"""Options of `zebro-lab rig run`, with those of an adaptive experiment."""

from dataclasses import dataclass
from typing import Annotated

from typer import Option

from zebro_lab.adaptive.wanted import Wanted, parse_wanted
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.files.errors import SettingsError
from zebro_lab.suggest.request import LONGEST_TIME
from zebro_lab.terminal.limits import Limits


@dataclass(frozen=True)
class AdaptiveRequest(RigRunRequest):
    """Options of `zebro-lab rig run`."""

    adaptive: Annotated[
        tuple[str, ...],
        Option(
            metavar="TARGET[=WIDTH]",
            help="After PLAN go on in rounds, each where it tells most of TARGET (as of rig "
            "suggest), until its 90 % interval is ± WIDTH or --budget is spent; WIDTH of a force "
            "is relative; may be repeated.",
        ),
    ] = ()
    budget: Annotated[
        float | None,
        Option(
            metavar="SECONDS",
            help="Time of all rounds of --adaptive, as rig plan estimates it [s]; default: three "
            "times that of PLAN.",
        ),
        Limits(above=0.0, most=LONGEST_TIME),
    ] = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` or `BadParameter` for values of another form."""
        _ = self.wanted
        super().__post_init__()
        if self.budget is not None and not self.adaptive:
            raise SettingsError(
                "belongs to --adaptive; name a target, as in --adaptive slip_stiffness=0.3, or "
                "leave it out",
                key="--budget",
            )

    @property
    def wanted(self) -> tuple[Wanted, ...]:
        """Targets of `--adaptive`, parsed."""
        return tuple(map(parse_wanted, self.adaptive))
