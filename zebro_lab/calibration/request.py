# SPDX-License-Identifier: MIT
"""Options of a calibration."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from typer import Argument, Option

from model.slip_laws import SLIP_LAWS
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range
from zebro_lab.workers import WorkersRequest

COMPARE: Final = "compare"
"""Value of `--law` that compares all laws."""
if TYPE_CHECKING:
    LawName: TypeAlias = str
else:
    LawName = Literal[*SLIP_LAWS, COMPARE]
SidesName: TypeAlias = Literal["together", "apart", "auto"]
EngineName: TypeAlias = Literal["auto", "laplace"]
DefinitionName: TypeAlias = Literal["material", "travel", "larger"]


@dataclass(frozen=True)
class CalibrationRequest:
    """Options of `calibrate-slip` for the fit of a slip law to rig data."""

    data: Annotated[
        tuple[Path, ...],
        Argument(metavar="DATA", help="Run folders, tables, or folders of them."),
    ] = ()
    out: Annotated[Path, Option(metavar="DIR", help="Calibration folder to write.")] = Path(
        "calibration"
    )
    columns: Annotated[
        Path | None,
        Option(metavar="FILE", help="columns.toml to use instead of those beside the tables."),
    ] = None
    slip_definition: Annotated[
        DefinitionName | None,
        Option(help="Definition of the slip ratio to fit in; default: that of the data."),
    ] = None
    law: Annotated[
        LawName,
        Option(
            help="Slip law; compare fits the simplest of all that predicts runs and loads that are "
            "left out no worse than the others."
        ),
    ] = "magic-formula"
    load_sensitivity: Annotated[
        bool, Option("--load-sensitivity", help="Let friction and stiffness vary with load.")
    ] = False
    sides: Annotated[
        SidesName,
        Option(
            help="Driving and braking: one curve (together); stiffness and friction of each side "
            "(apart); or apart if that predicts left-out runs clearly better (auto)."
        ),
    ] = "together"
    prior: Annotated[
        tuple[str, ...],
        Option(
            metavar="PRIOR",
            help='What is known of a parameter: "friction = 0.40 ± 0.05" (or +/-), "NAME ~ '
            'lognormal(MEDIAN, SPREAD)", "NAME ~ uniform(LOW, HIGH)"; SI, or with a unit behind. '
            "Replaces that of [priors] in columns.toml.",
        ),
    ] = ()
    prior_from: Annotated[
        Path | None,
        Option(metavar="DIR", help="Calibration whose posterior is the prior of this fit."),
    ] = None
    carry: Annotated[
        Literal["all", "law"],
        Option(
            help="What --prior-from carries over: all, for the same load cell, or law, for another."
        ),
    ] = "all"
    engine: Annotated[
        EngineName,
        Option(
            help="auto: a first answer by weighted draws of the Laplace approximation, which emcee "
            "then confirms; laplace: the first answer alone, as a calibration that was not "
            "confirmed.",
        ),
    ] = "auto"
    max_steps: Annotated[
        int,
        Option(
            help="Largest number of sampler moves; a fit that has not converged ends then, but not "
            "before its first look at 100 moves.",
        ),
        Range(least=1),
    ] = 30_000
    seed: Annotated[int, Option(help="Seed of all random numbers."), Range(least=0)] = 1
    workers: WorkersRequest = field(default_factory=WorkersRequest)
    resume: Annotated[bool, Option("--resume", help="Resume the stopped fit in --out.")] = False
    form: FormatOption = "png"

    def __post_init__(self) -> None:
        """Raise `SettingsError` for options that contradict each other, or an unreadable prior."""
        self._require_priors()
        if self.resume and self.engine == "laplace":
            raise SettingsError(
                "--resume goes on with a stopped fit by emcee; leave out --engine laplace, which "
                "takes seconds",
                key="--engine",
            )
        if self.law == COMPARE:
            self._require_comparable()
        elif self.law != "magic-formula" and self.load_sensitivity:
            raise SettingsError(
                f"--load-sensitivity belongs to the Magic Formula, not to '{self.law}'; leave it "
                "out",
                key="--law",
            )

    def _require_comparable(self) -> None:
        """Raise `SettingsError` for an option that `--law compare` excludes."""
        if self.load_sensitivity:
            raise SettingsError(
                "--law compare fits the Magic Formula both with and without dependence on load; "
                "leave out --load-sensitivity",
                key="--law",
            )
        if self.sides == "auto":
            raise SettingsError(
                "--law compare compares laws with their sides alike; choose --sides together or "
                "apart, or compare first and give --sides auto with the law that was fitted",
                key="--sides",
            )
        if self.prior_from is not None:
            raise SettingsError(
                "--prior-from is the posterior of one law, whose parameters the others do not "
                "have; leave out one of the two",
                key="--law",
            )

    def _require_priors(self) -> None:
        """Raise `SettingsError` if a prior cannot be parsed, or does not fit the other options."""
        if self.prior:
            from zebro_lab.calibration.prior_argument import parse_prior

            for text in self.prior:
                parse_prior(text, key="--prior")
        if self.prior_from is not None and self.sides == "auto":
            raise SettingsError(
                "--prior-from is the posterior of one law, with its sides together or apart; leave "
                "out --sides",
                key="--sides",
            )
        if self.prior_from is None and self.carry != "all":
            raise SettingsError(
                "--carry belongs to --prior-from; name a calibration, or leave it out",
                key="--carry",
            )

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Paths given as data, `columns.toml` and earlier calibration, as written."""
        return (*self.data, *(each for each in (self.columns, self.prior_from) if each is not None))

    def decisive(self) -> dict[str, object]:
        """Return the options that a resumed fit must share with the stopped one, JSON-serialisable.

        Left out are data and column map, whose content is hashed, and `out`, `max_steps`,
        `workers`, `resume` and `form`.
        """
        return {
            "slip_definition": self.slip_definition,
            "law": self.law,
            "load_sensitivity": self.load_sensitivity,
            "sides": self.sides,
            "prior": list(self.prior),
            "prior_from": None if self.prior_from is None else str(self.prior_from),
            "carry": self.carry,
            "sampled": self.engine != "laplace",
            "seed": self.seed,
        }
