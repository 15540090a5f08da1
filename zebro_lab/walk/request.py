# SPDX-License-Identifier: MIT
"""Options of `walk` and `predict`: the walk, its model, band, pictures and contact states."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final, Literal, TypeAlias

from typer import Argument, BadParameter, Option

from model.walk.slipping import SLIPPING
from zebro_lab.calibration.coulomb_argument import coulomb_numbers
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.gait_request import GaitRequest, Side
from zebro_lab.terminal.leg_options import JOINTS, TOPIC, joint_names
from zebro_lab.terminal.picture_options import (
    FormatOption,
    Instants,
    Window,
    parse_instants,
    parse_window,
)
from zebro_lab.terminal.request_command import Range
from zebro_lab.workers import SchedulerOption, WorkersRequest


@dataclass(frozen=True)
class BandRequest:
    """Options of the band: draws, seed, workers, spread of leg offsets."""

    draws: Annotated[
        int,
        Option(help="Draws for the band (draws.npz, band.csv, band.png), 2 or more; 0 for none."),
        Range(least=0),
    ] = 0
    seed: Annotated[int, Option(help="Seed of the band's draws."), Range(least=0)] = 1
    offset_sd_deg: Annotated[
        float | None,
        Option(
            metavar="DEG",
            help="Standard deviation of the unknown leg offsets [deg]; default: encoder step / "
            "sqrt(12), or 0.3 for angles that are not in encoder steps.",
        ),
    ] = None
    scheduler: SchedulerOption = None

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            SettingsError: The number of draws is 1 or negative, the standard deviation of leg
                offsets is negative and there are draws, or the address of a scheduler has another
                form or is given without draws.
        """
        _ = self.workers  # checks the address
        if self.draws < 2 and self.draws != 0:
            raise SettingsError(
                f"is {self.draws}; expected 2 or more, or 0 for no band", key="--draws"
            )
        if self.draws and (self.offset_sd_deg or 0.0) < 0:
            raise SettingsError("expected 0 or more", key="--offset-sd-deg")
        if self.scheduler is not None and not self.draws:
            raise SettingsError(
                "hands the draws of a band to a cluster; give --draws too, or leave it out",
                key="--scheduler",
            )

    @property
    def workers(self) -> WorkersRequest:
        """Where draws are walked: the scheduler's workers, or all cores of this machine."""
        return WorkersRequest(scheduler=self.scheduler)


@dataclass(frozen=True)
class PictureRequest:
    """Options of what is drawn and listed of a walk: figures, film and contact states."""

    figures: Annotated[
        bool, Option("--figures", help="Draw figures of path, motion, forces and contacts.")
    ] = False
    at: Annotated[
        Instants | None,
        Option(
            parser=parse_instants, metavar="T1,T2,…",
            help="With --figures: times of the snapshots on the path [s]; default: six, evenly "
            "spaced.",
        ),
    ] = None  # fmt: skip
    window: Annotated[
        Window | None,
        Option(
            parser=parse_window, metavar="BEGIN:END",
            help="With --figures or --contacts: time that motion, forces and contacts are drawn of "
            "[s]; default: the last two cycles of walking, motion whole; of a program all.",
        ),
    ] = None  # fmt: skip
    form: FormatOption = "png"
    animate: Annotated[
        bool, Option("--animate", help="Write an animation: mp4, or gif without ffmpeg.")
    ] = False

    contacts: Annotated[
        bool,
        Option(
            "--contacts",
            help="Write contact states (contacts.csv, a figure) and touchdowns of each leg "
            "(touchdowns.csv), and print the sequence of a cycle.",
        ),
    ] = False

    def __post_init__(self) -> None:
        """Raise `BadParameter` for times of snapshots, or a window of time, without figures."""
        if self.at is not None and not self.figures:
            raise BadParameter("says what figures show; give --figures too", param_hint="'--at'")
        if self.window is not None and not (self.figures or self.contacts):
            raise BadParameter(
                "says what figures show; give --figures or --contacts too", param_hint="'--window'"
            )

    @property
    def snapshots(self) -> tuple[float, ...]:
        """Times of `--at` [s]; empty if it was not given."""
        return () if self.at is None else self.at.t


ModelName: TypeAlias = Literal["dynamics", "thesis", "no-slip", "no-slip-simple"]
RuleName: TypeAlias = Literal["listing", "text"]


LONGEST_STEP: Final = 0.02
"""Longest time step [s], for models without slip: with it, paths of cycles of 0.5 s hold to 1 %."""
LONGEST_SLIPPING_STEP: Final = 0.005
"""The same for models with slip; longer steps leave the path, and give false slip."""


SlipOption: TypeAlias = Annotated[
    str | None,
    Option(
        help="Slip law: a slip.toml, its folder, thesis, or coulomb:MU[:V], friction MU, 71 % "
        "of it at slip velocity V (0.001 m/s). Required by dynamics and thesis.",
        metavar="SLIP",
    ),
]
RobotOption: TypeAlias = Annotated[
    Path | None, Option(metavar="FILE", help="robot.toml; default: the thesis's robot.")
]
StepOption: TypeAlias = Annotated[
    float | None,
    Option(
        metavar="SECONDS",
        help=f"Time step [s], at most {LONGEST_SLIPPING_STEP:g} with slip and "
        f"{LONGEST_STEP:g} without; default: the model's.",
    ),
    Range(above=0),
]
GroundOption: TypeAlias = Annotated[
    Path | None,
    Option(
        metavar="FILE",
        help="ground.toml: slope and map of heights, for dynamics; default: flat.",
    ),
]


@dataclass(frozen=True)
class ModelRequest:
    """Options of model, slip law, robot, band and pictures, shared by `walk` and `predict`."""

    slip: SlipOption = None
    model: Annotated[
        ModelName,
        Option(
            help="Walking model. dynamics: rigid body on slipping legs; thesis: the thesis's, "
            "with its errors; no-slip: exact kinematics; no-slip-simple: wheels."
        ),
    ] = "dynamics"
    robot: RobotOption = None
    dt: StepOption = None
    ground: GroundOption = None
    band: BandRequest = field(default_factory=BandRequest)
    pictures: PictureRequest = field(default_factory=PictureRequest)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Given values of `--slip`, `--robot` and `--ground`, as paths.

        `--slip thesis` is left out; `coulomb:…`, although no file, is not.
        """
        slip = () if self.slip in (None, "thesis") else (Path(self.slip),)
        return (*slip, *(file for file in (self.robot, self.ground) if file is not None))

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            SettingsError: A `coulomb:…` is no friction law, the step is too long, or a ground is
                given for a model that walks on level ground only.
        """
        if self.slip is not None:
            coulomb_numbers(self.slip)
        if self.ground is not None and self.model != "dynamics":
            raise SettingsError(
                f"the model '{self.model}' walks on level ground only; expected "
                "--model dynamics with it",
                key="--ground",
            )
        longest = LONGEST_SLIPPING_STEP if self.model in SLIPPING else LONGEST_STEP
        if self.dt is not None and self.dt > longest:
            raise SettingsError(
                f"found {self.dt:g} s; expected at most {longest:g} s with the model "
                f"'{self.model}': longer steps skip contacts, and their slip is false",
                key="--dt",
            )

    def require_slip(self) -> None:
        """Check that `--slip` is given if the model needs it.

        Raises:
            BadParameter: The model has slipping legs and `--slip` is missing.
        """
        if self.slip is None and self.model in SLIPPING:
            raise BadParameter(
                f"missing: legs slip in the model '{self.model}'; name a slip.toml, the folder "
                "that holds it, coulomb:MU[:V] or thesis",
                param_hint="'--slip'",
            )


@dataclass(frozen=True)
class WalkRequest:
    """Options of `zebro-lab walk`."""

    gait: GaitRequest = field(default_factory=GaitRequest)
    duration: Annotated[
        float | None,
        Option(metavar="SECONDS", help="Duration of the walk, required without a program [s]."),
        Range(above=0),
    ] = None
    out: Annotated[Path, Option(metavar="DIR", help="Walk folder to write.")] = Path("walk")
    model: ModelRequest = field(default_factory=ModelRequest)
    thesis: Annotated[
        RuleName,
        Option(
            help="What --model thesis follows where they differ. listing: contacts by A.32, and "
            "each change sets the body's height; text: contacts by Table 3-1, and the body sinks."
        ),
    ] = "listing"
    program: Annotated[
        Path | None,
        Argument(
            metavar="PROGRAM", show_default=False,
            help="Walking program (TOML) of several gaits, instead of the options of one.",
        ),
    ] = None  # fmt: skip

    def __post_init__(self) -> None:
        """Raise `BadParameter` for options of a gait beside a program, or of another model."""
        if self.thesis != "listing" and self.model.model != "thesis":
            raise BadParameter(
                f"is of the thesis's model, not of '{self.model.model}': give --model thesis too",
                param_hint="'--thesis'",
            )
        if self.program is None:
            return
        given = self.gait.given()
        options = [*(("duration",) if self.duration is not None else ()), *given]
        if options or self.gait.name != GaitRequest().name:
            name = options[0].replace("_", "-") if options else "gait"
            raise BadParameter("is for one gait; the program says it", param_hint=f"'--{name}'")

    def require_slip(self) -> None:
        """Check that `--slip` is given if the model needs it, as far as the gait's name tells.

        The thesis's model walks gaits that are no tripods without; whether groups of legs are one
        is seen when they are walked.

        Raises:
            BadParameter: The walk has slipping legs and `--slip` is missing.
        """
        may_be_kinematic = self.gait.name == "tetrapod" or "{" in self.gait.name
        if self.model.model != "thesis" or not may_be_kinematic:
            self.model.require_slip()


@dataclass(frozen=True)
class PredictRequest:
    """Options of `zebro-lab predict`."""

    log: Annotated[
        Path,
        Argument(
            metavar="LEGLOG",
            help="Leg angles over time: a table, a ROS log, a recorded run or a walk folder.",
        ),
    ]
    out: Annotated[
        Path | None,
        Option(
            metavar="DIR",
            help="Walk folder to write; default: RUN/prediction for a run, else prediction.",
        ),
    ] = None
    columns: Annotated[
        Path | None,
        Option(metavar="FILE", help="columns.toml to use instead of the one beside LEGLOG."),
    ] = None
    joints: Annotated[str | None, Option(metavar="A,B,C,D,E,F", help=JOINTS)] = None
    topic: Annotated[tuple[str, ...], Option(metavar="NAME", help=TOPIC)] = ()
    direction: Annotated[
        Side,
        Option(help="Side the gait turns to, for --model thesis and the baseline of validate."),
    ] = "left"
    model: ModelRequest = field(default_factory=ModelRequest)

    def __post_init__(self) -> None:
        """Raise `SettingsError` for `--joints` that are not six different names."""
        joint_names(self.joints)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Paths of leg log, `--columns`, `--slip`, `--robot` and `--ground`, as far as given."""
        columns = () if self.columns is None else (self.columns,)
        return (self.log, *columns, *self.model.inputs)
