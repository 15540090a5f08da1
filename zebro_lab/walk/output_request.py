# SPDX-License-Identifier: MIT
"""Options of what a walk writes beside its path: band, pictures and contact states."""

from dataclasses import dataclass, field
from typing import Annotated, Final

from typer import BadParameter, Option

from model.lateral_spread import ANISOTROPY
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.limits import Limits
from zebro_lab.terminal.picture_options import (
    FormatOption,
    Instants,
    Window,
    parse_instants,
    parse_window,
)
from zebro_lab.workers import WorkersRequest

MOST_ANISOTROPY: Final = 3.0
"""Largest factor by which lateral traction may be said to differ from longitudinal [-]."""
LEAST_CONTACT: Final = 0.01
"""Contact states that last less are joined to the next: five steps of the model dynamics [s]."""


ANISOTROPY_LIMITS: Final = Limits(least=1, most=MOST_ANISOTROPY)


@dataclass(frozen=True)
class BandRequest:
    """Options of the band: draws, seed, workers, spread of leg offsets, lateral traction, start."""

    draws: Annotated[
        int,
        Option(
            min=0, help="Draws for the band (draws.npz, band.csv, band.png), 2 or more; 0 for none."
        ),
    ] = 0
    seed: Annotated[int, Option(min=0, help="Seed of the band's draws.")] = 1
    offset_sd_deg: Annotated[
        float | None,
        Option(
            min=0.0,
            metavar="DEG",
            help="Standard deviation of the unknown leg offsets [deg]; default: encoder step / "
            "sqrt(12), or 0.3 for angles that are not in encoder steps.",
        ),
    ] = None
    anisotropy: Annotated[
        float | None,
        Option(
            metavar="FACTOR",
            help="Lateral over longitudinal grip, and lateral over longitudinal slip stiffness of "
            "the legs: 1 ×/÷ this factor each, one standard deviation; 1 for alike. Default: "
            f"{ANISOTROPY:g}.",
        ),
        ANISOTROPY_LIMITS,
    ] = None
    start_sd: Annotated[
        tuple[float, float, float],
        Option(
            help="Standard deviation of the start pose: x y [m] yaw [deg].",
            metavar="X Y YAW",
            min=0.0,
        ),
    ] = (0.0, 0.0, 0.0)
    workers: WorkersRequest = field(default_factory=WorkersRequest)

    def __post_init__(self) -> None:
        """Raise `SettingsError` for one or negative draws, their negative sd, or none to share."""
        if self.draws < 2 and self.draws != 0:
            raise SettingsError(
                f"is {self.draws}; expected 2 or more, or 0 for no band", key="--draws"
            )
        if self.draws and any(sd < 0 for sd in (*self.start_sd, self.offset_sd_deg or 0.0)):
            raise SettingsError("expected standard deviations of 0 or more", key="--start-sd")
        if self.workers.scheduler is not None and not self.draws:
            raise SettingsError(
                "hands the draws of a band to a cluster; give --draws too, or leave it out",
                key="--scheduler",
            )
        if self.anisotropy is not None and not ANISOTROPY_LIMITS.hold(self.anisotropy):
            raise SettingsError(
                f"found {self.anisotropy:g}; expected {ANISOTROPY_LIMITS}", key="--anisotropy"
            )


@dataclass(frozen=True)
class PictureRequest:
    """Options of the pictures of a walk: which, in what format, at what times."""

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

    def __post_init__(self) -> None:
        """Raise `BadParameter` for times of snapshots without figures."""
        if self.at is not None and not self.figures:
            raise BadParameter("says what figures show; give --figures too", param_hint="'--at'")

    @property
    def snapshots(self) -> tuple[float, ...]:
        """Times of `--at`, none if it was not given [s]."""
        return () if self.at is None else self.at.t


@dataclass(frozen=True)
class ContactRequest:
    """Options of the contact states of a walk."""

    contacts: Annotated[
        bool,
        Option(
            "--contacts",
            help="Write contact states by rigid legs and by the model (contacts.csv, a figure) and "
            "touchdowns of each leg (touchdowns.csv), and print the sequence of a cycle.",
        ),
    ] = False
    contacts_least: Annotated[
        float | None,
        Option(
            min=0.0,
            metavar="SECONDS",
            help="With --contacts: shorter contact states are joined to the next, and shorter gaps "
            "in a leg's contact left out [s]; default: 0.01.",
        ),
    ] = None

    def __post_init__(self) -> None:
        """Raise `BadParameter` for a shortest state without contact states."""
        if self.contacts_least is not None and not self.contacts:
            raise BadParameter(
                "says how contacts are listed; give --contacts too", param_hint="'--contacts-least'"
            )

    @property
    def least(self) -> float:
        """Shortest time that a contact state lasts [s]."""
        return LEAST_CONTACT if self.contacts_least is None else self.contacts_least
