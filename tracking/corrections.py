# SPDX-License-Identifier: MIT
"""Manual corrections of tracked poses, kept as data and replayed on the tracker's observations.

Corrections are applied in the order in which they were made; the tracker's observations are not
overwritten. The same corrections on the same observations give the same result.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, asdict, dataclass, fields, replace
from typing import Any, TypeAlias

import numpy as np

from model.similar_name import similar_name
from tracking.errors import CorrectionError
from tracking.path import PoseObservation
from tracking.pose import HELD, PLANAR, BodyPose, BodyPrior
from tracking.shared import ANNOTATION, CAMERA, LENS, PLACE

_IN_BODY = (ANNOTATION, PLACE)  # causes whose x and y are of the body frame


@dataclass(frozen=True)
class Move:
    """Set the robot's pose in a photograph, whether or not the tracker found it there.

    A pose found there keeps its time, and the error that it has from the camera's pose and lens.

    Attributes:
        photo: Name of the photograph.
        x: x of the body's origin on the floor [m].
        y: y of the body's origin on the floor [m].
        yaw: Heading of the robot [rad].
        position_sd: Standard deviation of x and of y [m].
        yaw_sd: Standard deviation of the heading [rad].
    """

    photo: str
    x: float
    y: float
    yaw: float
    position_sd: float = 5e-3
    yaw_sd: float = 0.05


@dataclass(frozen=True)
class Flip:
    """Exchange the robot's head and tail in a photograph: add pi to its yaw.

    Attributes:
        photo: Name of the photograph.
    """

    photo: str


@dataclass(frozen=True)
class Delete:
    """Remove the observation of a photograph, for instance one that is not of the robot.

    Attributes:
        photo: Name of the photograph.
    """

    photo: str


Correction: TypeAlias = Move | Flip | Delete
_KINDS: dict[str, type[Correction]] = {"move": Move, "flip": Flip, "delete": Delete}


def replay(
    observations: Sequence[PoseObservation], corrections: Iterable[Correction], *,
    prior: BodyPrior, times: Mapping[str, tuple[float, float]] | None = None,
) -> tuple[PoseObservation, ...]:  # fmt: skip
    """Apply corrections to observations.

    Args:
        observations: The tracker's observations.
        corrections: The corrections, in the order in which they were made.
        prior: Prior of the body's height and tilt: those of a pose that a `Move` sets.
        times: By photograph, time and its standard deviation [s]; needed to `Move` the robot into
            a photograph without an observation.

    Returns:
        Corrected observations in the given order, those added by a `Move` last; unchanged
        observations are the same objects.

    Raises:
        CorrectionError: When a correction names a photograph without an observation (a `Move`:
            also without a time).
    """
    found = {seen.photo: seen for seen in observations}
    for correction in corrections:
        if isinstance(correction, Move):
            found[correction.photo] = _moved(found, correction, times or {}, prior)
        elif isinstance(correction, Delete):
            _known(found, correction.photo)
            del found[correction.photo]
        else:
            found[correction.photo] = _flipped(_known(found, correction.photo))
    return tuple(found.values())


def correction_from(entry: Mapping[str, Any]) -> Correction:
    """Parse a correction from plain values, as a file holds them.

    Args:
        entry: `kind` ("move", "flip" or "delete") and the attributes of that kind.

    Raises:
        CorrectionError: The kind or a key is unknown, a required key is missing, or a value is
            not a name, a finite number or, for a standard deviation, a positive
            one.
    """
    kind = str(entry.get("kind", ""))
    if kind not in _KINDS:
        raise CorrectionError(f"kind '{kind}' is missing or unknown; expected {', '.join(_KINDS)}")
    values = {key: value for key, value in entry.items() if key != "kind"}
    for key, value in values.items():
        _require_value(kind, key, value)
    needed = [each.name for each in fields(_KINDS[kind]) if each.default is MISSING]
    missing = [name for name in needed if name not in values]
    if missing:
        raise CorrectionError(f"correction '{kind}' needs {', '.join(missing)}")
    return _KINDS[kind](**values)


def _require_value(kind: str, key: str, value: Any) -> None:
    """Raise `CorrectionError` for an unknown key, or a value that its attribute cannot hold."""
    names = [field.name for field in fields(_KINDS[kind])]
    if key not in names:
        near = similar_name(key, names)
        hint = f"did you mean '{near}'?" if near else f"known: {', '.join(names)}"
        raise CorrectionError(f"correction '{kind}' has no '{key}'; {hint}")
    if key == "photo":
        wanted, valid = "a name", isinstance(value, str)
    else:
        sd = key.endswith("_sd")
        wanted = "a number above 0, finite" if sd else "a finite number"
        valid = isinstance(value, int | float) and math.isfinite(value) and not (sd and value <= 0)
    if not valid:
        raise CorrectionError(f"{key} of correction '{kind}' is {value!r}; expected {wanted}")


def plain(correction: Correction) -> dict[str, Any]:
    """Convert a correction to a dictionary of plain values; inverse of `correction_from`.

    >>> plain(Flip("p3.jpg"))
    {'kind': 'flip', 'photo': 'p3.jpg'}
    """
    kind = next(name for name, kind in _KINDS.items() if isinstance(correction, kind))
    return {"kind": kind, **asdict(correction)}


def _known(found: Mapping[str, PoseObservation], photo: str) -> PoseObservation:
    """Return the observation of a photograph; raise `CorrectionError` where there is none."""
    if photo not in found:
        near = similar_name(photo, found)
        hint = f"; did you mean '{near}'?" if near else "; correct the name, or remove it"
        raise CorrectionError(f"a correction names '{photo}', of which there is no pose{hint}")
    return found[photo]


def _flipped(seen: PoseObservation) -> PoseObservation:
    """Exchange head and tail: the place stays, and what the body's frame has turns by half a turn.

    Roll and pitch change their signs, as do their covariances with the other coordinates, and the
    displacements by errors that are given in the body frame.
    """
    pose, turn = seen.pose, np.diag([1.0, 1.0, 1.0, -1.0, -1.0, 1.0])
    state = turn @ pose.state
    state[5] = float(np.angle(np.exp(1j * (state[5] + np.pi))))
    covariance = turn @ pose.covariance @ turn
    by_cause = {}
    for cause, derivative in pose.by_cause.items():
        by_cause[cause] = turn @ derivative
        if cause in _IN_BODY:
            by_cause[cause][:2] *= -1.0
    flipped = replace(pose, state=state, covariance=covariance, by_cause=by_cause)
    return replace(seen, pose=flipped)


def _moved(
    found: Mapping[str, PoseObservation],
    move: Move,
    times: Mapping[str, tuple[float, float]],
    prior: BodyPrior,
) -> PoseObservation:
    """Return the observation with the pose that a person set, level and at the prior's height.

    Of an observation found there it keeps the time, and the derivatives by camera and lens.

    Raises:
        CorrectionError: The photograph has neither an observation nor a time.
    """
    state = np.array([move.x, move.y, prior.height, 0.0, 0.0, move.yaw])
    covariance = np.zeros((6, 6))
    covariance[PLANAR, PLANAR] = np.square([move.position_sd, move.position_sd, move.yaw_sd])
    covariance[np.ix_(HELD, HELD)] = prior.covariance
    if move.photo in found:
        seen = found[move.photo]
        by_camera = {cause: seen.pose.by_cause[cause] for cause in (CAMERA, LENS)
                     if cause in seen.pose.by_cause}  # fmt: skip
        pose = BodyPose(state, covariance, by_camera)
        return replace(seen, pose=pose, score=1.0, source="hand")
    if move.photo not in times:
        _known(found, move.photo)
    t, t_sd = times[move.photo]
    return PoseObservation(move.photo, t, t_sd, BodyPose(state, covariance), 1.0, "hand")
