# SPDX-License-Identifier: MIT
"""Shared by `walk` and `predict`: compute a path from leg angles, and write the walk folder."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from model.errors import DefinitionMismatch, DomainError
from model.gait.direction import Direction
from model.gait.reference import LegReference
from model.predict import FINE
from model.progress import Watcher
from model.robot import Robot
from model.walk.path import WalkPath
from model.walk_models import MODELS, ModelRun, WalkModel
from zebro_lab.calibration.slip_argument import EXPECTED_SLIP, NamedSlip, parse_slip
from zebro_lab.files.errors import SettingsError, ZebroLabError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.walk.folder import walk_folder
from zebro_lab.walk.informed_legs import InformedLegs, informed_legs
from zebro_lab.walk.pictures import animate_walk, draw_walk
from zebro_lab.walk.request import ModelRequest

INFORMED_MODEL = "dynamics"  # the model with which legs and floor were fitted to walks

MOST_STEPS: Final = 500_000
"""Largest number of time steps; each takes about 1.1 kB while a path is computed and written."""


class WalkStopped(ZebroLabError):
    """A walk was stopped on request; nothing was written."""


@dataclass(frozen=True)
class Walked:
    """A finished walk.

    Attributes:
        path: The path.
        reference: Leg angles that it was computed from.
        described: The robot, as requested.
        slip: Slip law of its legs; None for a model without slip.
        model: Name of the model.
        dt: Time step [s].
        title: Gait and model.
        notes: Notes, one line each.
        informed: Posterior of its legs and floor; None without fitted walks.
    """

    path: WalkPath
    reference: LegReference
    described: RobotFile
    slip: NamedSlip | None
    model: str
    dt: float
    title: str
    notes: tuple[str, ...]
    informed: InformedLegs | None = None


def robot_of(request: ModelRequest) -> RobotFile:
    """Return the robot of a request: from its file or the thesis's, with the requested arc.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file or the arc has an invalid value.
    """
    described = RobotFile() if request.robot is None else read_robot_file(request.robot)
    if request.arc_deg is None:
        return described
    try:
        robot = replace(described.robot, leg_arc=float(np.radians(request.arc_deg)))
    except DomainError as error:
        raise SettingsError(str(error), key="--arc-deg") from error
    return replace(described, robot=robot)


def walk_with(
    request: ModelRequest,
    described: RobotFile,
    reference: LegReference,
    *,
    duration: float,
    what: str,
    direction: Direction = "left",
    logs: tuple[Path, ...] = (),
    angles_are_true: bool = False,
    notes: tuple[str, ...] = (),
) -> Walked:
    """Compute the path of a robot from its leg angles, from time zero on.

    Args:
        request: Model, slip law and options.
        described: The robot.
        reference: Leg angles over time.
        duration: Duration of the walk [s].
        what: Name of the gait or log, for titles.
        direction: Side the gait turns to.
        logs: Files of the leg log, by which a walk that was fitted is recognised.
        angles_are_true: Whether the angles are exact, as those of a walked path, without offsets.
        notes: Notes to add to, one line each.

    Raises:
        SettingsError: The model needs a slip law and has none, or an option has an invalid value.
        ModelError: The walk cannot be computed.
    """
    model = MODELS[request.model]
    slip = None if request.slip is None else parse_slip(request.slip)
    if slip is not None and not model.slips:
        notes = (*notes, f"the model '{model.name}' does not slip: --slip {slip.text} not used")
        slip = None
    if slip is None and model.slips:
        raise SettingsError(f"missing: this model slips; name {EXPECTED_SLIP}", key="--slip")
    dt = model.dt if request.dt is None else request.dt
    _require_steps(duration, dt)
    informed = None
    if slip is not None and slip.walks is not None and model.name == INFORMED_MODEL:
        informed = informed_legs(
            slip.walks, described, logs=logs, same_legs=False if angles_are_true else None
        )
        notes = (*notes, *informed.notes)
        if request.dt is None:
            dt = min(dt, FINE.dt)  # the time step with which its legs were fitted
            _require_steps(duration, dt)
    run = ModelRun(
        described.robot, reference, slip, duration, dt, request.toe, direction,
        None if informed is None else informed.middle,
    )  # fmt: skip
    path = _run(run, model, slip)
    grip = f", slip {slip.title}" if slip is not None else ""
    return Walked(
        path=path,
        reference=reference,
        described=described,
        slip=slip,
        model=model.name,
        dt=dt,
        title=f"{what}, model '{model.name}'{grip}",
        notes=(*notes, *(slip.notes if slip is not None else ())),
        informed=informed,
    )


def _run(run: ModelRun, model: WalkModel, slip: NamedSlip | None) -> WalkPath:
    try:
        return model.run(run)
    except DefinitionMismatch as error:
        raise SettingsError(
            f"was fitted to '{error.found}' slip, but the thesis's model takes '{error.expected}' "
            f"slip; calibrate again with --slip-definition {error.expected}, or use --model "
            "dynamics, which converts",
            file=None if slip is None else slip.text,
        ) from error


def _require_steps(duration: float, dt: float) -> None:
    """Check that the duration is positive and the number of steps fits into memory."""
    if not (dt > 0 and duration > dt and np.isfinite(duration)):
        raise SettingsError(
            f"{duration:g} s in steps of {dt:g} s is no walk; expected more than a step",
            key="--duration, --dt",
        )
    if duration / dt > MOST_STEPS:
        raise SettingsError(
            f"{duration:g} s in steps of {dt:g} s is {duration / dt:.3g} steps; at most "
            f"{MOST_STEPS:,} are walked, which take 1 GB of memory: walk for a shorter time, or "
            "lengthen --dt",
            key="--duration, --dt",
        )


def write_walk(
    out: Path,
    request: ModelRequest,
    walked: Walked,
    watcher: Watcher,
    *,
    kind: str,
    settings: Mapping[str, object],
    files: tuple[Path, ...] = (),
    extra: Callable[[Path], None] | None = None,
) -> None:
    """Write the walk folder with the requested pictures.

    Args:
        out: Folder to write.
        request: Which pictures to draw.
        walked: The finished walk.
        watcher: Receives progress.
        kind: "walk" or "predict".
        settings: Settings other than model, robot and slip, JSON-serialisable.
        files: Files read other than those of robot and slip.
        extra: Function that writes additional files into the folder.

    Raises:
        AlreadyExists: The folder is a file, or holds the result of another command.
        WalkStopped: The watcher asked to stop.
    """
    described, slip = walked.described, walked.slip
    read = [*files, *((described.file,) if described.file else ()), *(slip.files if slip else ())]
    everything = {
        "model": walked.model,
        "dt": walked.dt,
        "toe": request.toe,
        "slip": None if slip is None else {"named": slip.text, "source": slip.source},
        "robot": _robot_settings(described.robot),
        "walks": None if walked.informed is None else walked.informed.settings(),
        **settings,
    }
    with walk_folder(
        out,
        walked.path,
        kind=kind,
        source=f"sim:{walked.model}",
        settings=everything,
        inputs=file_hashes(read),
    ) as folder:
        _draw(request, walked, folder, watcher)
        if extra is not None:
            extra(folder)


def _draw(request: ModelRequest, walked: Walked, folder: Path, watcher: Watcher) -> None:
    robot, title = walked.described.robot, walked.title
    _heed(watcher)
    if request.figures:
        watcher.step("drawing", None)
        draw_walk(folder, walked.path, robot, title=title, period=walked.reference.period)
    if request.animate:

        def follow(fraction: float) -> None:
            watcher.step("filming", fraction)
            _heed(watcher)

        animate_walk(folder, walked.path, robot, title=title, progress=follow)


def _heed(watcher: Watcher) -> None:
    if watcher.stop_requested():
        raise WalkStopped("stopped; nothing was written")


def _robot_settings(robot: Robot) -> dict[str, object]:
    return {
        "mass": robot.mass,
        "body_size": list(robot.body_size),
        "inertia": robot.principal_inertia.tolist(),
        "leg_radius": robot.leg_radius,
        "leg_arc": robot.leg_arc,
        "leg_offset": robot.leg_offset.tolist(),
        "hips": robot.hips.tolist(),
    }
