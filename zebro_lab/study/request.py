# SPDX-License-Identifier: MIT
"""Options of `zebro-lab study`."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from typer import Option

from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.workers.request import WorkersRequest

FittedLaw: TypeAlias = Literal["magic-formula", "brush", "coulomb-stribeck"]
Wrong: TypeAlias = Literal["independent-noise", "perfect-rig"]


@dataclass(frozen=True)
class LayoutRequest:
    """Options of the experiment that is simulated, and of the priors of its fit."""

    plan: Annotated[
        Path | None,
        Option(
            metavar="FILE",
            help="Plan of an experiment, as of rig run, measured by the simulated rig; default: "
            "that of the bundled sweep.",
        ),
    ] = None
    calibration: Annotated[
        Path | None,
        Option(
            metavar="DIR",
            help="Calibration whose blocks, law and priors are simulated instead: your own data's.",
        ),
    ] = None
    prior: Annotated[
        tuple[str, ...],
        Option(metavar="PRIOR", help="What is known of a parameter, as in calibrate-slip."),
    ] = ()

    def __post_init__(self) -> None:
        """Raise `SettingsError` for a plan beside a calibration, or a prior of another form."""
        if self.plan is not None and self.calibration is not None:
            raise SettingsError(
                "--plan and --calibration both say what is simulated; leave one of them out",
                key="--plan",
            )
        if self.prior:
            from zebro_lab.calibration.prior_argument import parse_prior

            for text in self.prior:
                parse_prior(text, key="--prior")

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Paths that are read, as written."""
        return tuple(each for each in (self.plan, self.calibration) if each is not None)


Seed: TypeAlias = Annotated[int, Option(min=0, help="Seed of all random numbers.")]


@dataclass(frozen=True)
class SbcRequest:
    """Options of `zebro-lab study sbc`."""

    layout: LayoutRequest = field(default_factory=LayoutRequest)
    law: Annotated[
        FittedLaw | None, Option(help="Slip law, with --plan; default: magic-formula.")
    ] = None
    wrong: Annotated[
        Wrong | None,
        Option(
            help="Fit a wrong model on purpose, to see the check fail: noise without memory and "
            "runs without offsets, or a rig without errors of radii and rolling resistance."
        ),
    ] = None
    replicates: Annotated[
        int, Option(min=1, max=100_000, help="Experiments to simulate and fit.")
    ] = 300
    seed: Seed = 1
    workers: WorkersRequest = field(default_factory=WorkersRequest)
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("study-sbc")
    form: FormatOption = "png"

    def __post_init__(self) -> None:
        """Raise `SettingsError` for a law beside a calibration, which has one."""
        if self.law is not None and self.layout.calibration is not None:
            raise SettingsError(
                "--law belongs to --plan; the law of --calibration is its own: leave it out",
                key="--law",
            )


@dataclass(frozen=True)
class CoverageRequest:
    """Options of `zebro-lab study coverage`."""

    layout: LayoutRequest = field(default_factory=LayoutRequest)
    truth: Annotated[
        Path | None,
        Option(
            metavar="DIR",
            help="Calibration whose mean is the true law, with --plan; default: the thesis's "
            "curve. That of --calibration is its own mean.",
        ),
    ] = None
    replicates: Annotated[
        int, Option(min=1, max=100_000, help="Experiments to simulate and fit.")
    ] = 200
    seed: Seed = 1
    workers: WorkersRequest = field(default_factory=WorkersRequest)
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("study-coverage")
    form: FormatOption = "png"

    def __post_init__(self) -> None:
        """Raise `SettingsError` for a truth beside a calibration, which has one."""
        if self.truth is not None and self.layout.calibration is not None:
            raise SettingsError(
                "--truth belongs to --plan; the truth of --calibration is its own mean: leave it "
                "out",
                key="--truth",
            )
