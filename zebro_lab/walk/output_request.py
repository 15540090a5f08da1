# SPDX-License-Identifier: MIT
"""Options of what a walk writes beside its path: band, pictures and contact states."""

from dataclasses import dataclass
from typing import Annotated

from typer import BadParameter, Option

from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import (
    FormatOption,
    Instants,
    Window,
    parse_instants,
    parse_window,
)
from zebro_lab.workers import SchedulerOption, WorkersRequest


@dataclass(frozen=True)
class BandRequest:
    """Options of the band: draws, seed, workers, spread of leg offsets."""

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
    scheduler: SchedulerOption = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for one or negative draws, their negative sd, or none to share."""
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
            help="Write contact states (contacts.csv, a figure) and touchdowns of each leg "
            "(touchdowns.csv), and print the sequence of a cycle.",
        ),
    ] = False
