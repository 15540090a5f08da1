# SPDX-License-Identifier: MIT
"""Detect the floor's and the robot's markers in a photograph, and compute the robot's pose.

There are two steps, since the camera's pose needs all photographs. `detect` works on one photograph
at a time and in any order, so that photographs can be spread over processes. `observe` then
computes the robot's pose with the floor that `tracking.floor.refine_floor` has fitted to all.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.camera.lens import CameraPose, to_floor
from tracking.errors import MarkerError, PhotoError
from tracking.floor import FloorFit, FloorMap, FloorView
from tracking.markers import (
    Sighting,
    edge_growth,
    find_markers,
    guess_dictionary,
    marker_corners,
    marker_family,
    neighbourhood,
)
from tracking.path import PoseObservation
from tracking.pose import BodyPose, BodyPrior, fit_pose
from tracking.shared import EDGES, PLACE, SIDE, TURN


@dataclass(frozen=True)
class RobotMarker:
    """The marker on the robot's back.

    Attributes:
        marker_id: Number of the marker in its dictionary.
        side: Side of the black square, above 0, else MarkerError is raised [m].
        dictionary: Name of the dictionary.
        position: Centre of the marker in the body frame: forward, left, up [m].
        yaw: Turn of the print's left-to-right direction from the body's x, counter-clockwise
            [rad]; -pi/2 when the print's top points ahead.
        side_sd: Standard deviation of `side`; 0 takes it as exact [m].
        position_sd: Standard deviation of x and of y of `position`; 0 takes them as exact [m].
        yaw_sd: Standard deviation of `yaw`; 0 takes it as exact [rad].
    """

    marker_id: int
    side: float
    dictionary: str
    position: tuple[float, float, float]
    yaw: float = -np.pi / 2
    side_sd: float = 0.0
    position_sd: float = 0.0
    yaw_sd: float = 0.0

    def __post_init__(self) -> None:
        if not self.side > 0:
            raise MarkerError(f"the robot's marker has side {self.side} m; expected more than 0 m")

    @property
    def points_body(self) -> Array:
        """Corners of the marker in the body frame, OpenCV's order, shape (4, 3) [m]."""
        return marker_corners(self.side, self.position, self.yaw)

    def derivatives_at(self, points_body: Array) -> dict[str, Array]:
        """Differentiate points printed on the marker by its stated side, place and turn.

        Args:
            points_body: The points in the body frame, shape (n, 3) [m].

        Returns:
            By cause, derivative of the points by the side, the place (x, y) and the turn of the
            marker, shape (n, 3, k).
        """
        arm = points_body - np.asarray(self.position)
        turned = np.column_stack((-arm[:, 1], arm[:, 0], np.zeros(len(arm))))
        along = np.tile(np.eye(3)[:, :2], (len(arm), 1, 1))
        return {SIDE: arm[:, :, None] / self.side, PLACE: along, TURN: turned[:, :, None]}

    @property
    def spreads(self) -> dict[str, Array]:
        """Covariance of side, place and turn by cause, shape (k, k) [m², m², rad²]."""
        variance = {SIDE: [self.side_sd], PLACE: 2 * [self.position_sd], TURN: [self.yaw_sd]}
        return {cause: np.diag(np.square(sd)) for cause, sd in variance.items()}


@dataclass(frozen=True)
class MarkedRobot:
    """A robot with a marker.

    Attributes:
        marker: The marker on its back.
        prior: Prior of the body's height and tilt.
    """

    marker: RobotMarker
    prior: BodyPrior


@dataclass(frozen=True)
class Detection:
    """Markers detected in one photograph.

    Attributes:
        photo: Name of the photograph.
        floor: Corners of the floor's markers in the photograph, without markers detected twice.
        robot: The robot's marker in the photograph; None where it is not detected, or none is
            wanted.
    """

    photo: str
    floor: FloorView
    robot: Sighting | None


def detect(
    photo: str, pixels: NDArray[np.uint8], *, floor: FloorMap, robot: MarkedRobot,
    hint: Detection | None = None, reach: float = 1.5,
) -> Detection:  # fmt: skip
    """Detect the floor's markers and the robot's marker in one photograph.

    Args:
        photo: Name of the photograph.
        pixels: The photograph, grey or BGR.
        floor: The floor map; of its marks only markers are detected.
        robot: The robot's marker, of a number that no floor marker has.
        hint: Detection in a photograph taken shortly before or after. Markers are first searched
            near their places there; the whole photograph only for markers not found that way.
        reach: How far the robot may have moved from `hint`, in sides of its marker [-].

    Returns:
        The markers detected.

    Raises:
        PhotoError: When the robot's marker is detected more than once, or the map has markers and
            none of them is detected.
        MarkerError: When there is no dictionary of a given name.
    """
    found = [] if hint is None else _near(pixels, floor, robot, hint, reach)
    missing = _missing(floor, robot, found)
    if missing:
        for dictionary, numbers in missing.items():
            found += find_markers(pixels, dictionary, wanted=numbers)
    on_floor = [s for s in found if s.marker_id in floor.marker_ids]
    robots = [s for s in found if s.marker_id == robot.marker.marker_id]
    if len(robots) > 1:
        raise PhotoError(
            photo,
            f"the robot's marker {robot.marker.marker_id} is seen {len(robots)} times, expected "
            f"once; cover its other prints, or track a composite picture alone",
        )
    if floor.markers and not on_floor:
        raise PhotoError(photo, _no_floor(pixels, floor))
    return Detection(photo, FloorView.of(photo, on_floor), robots[0] if robots else None)


def _missing(
    floor: FloorMap, robot: MarkedRobot, found: Sequence[Sighting]
) -> dict[str, list[int]]:
    """List by dictionary the numbers of the markers of floor and robot that are not yet found."""
    numbers = {sighting.marker_id for sighting in found}
    missing: dict[str, list[int]] = {}
    for number in floor.marker_ids:
        if number not in numbers:
            missing.setdefault(floor.dictionary, []).append(number)
    if robot.marker.marker_id not in numbers:
        missing.setdefault(robot.marker.dictionary, []).append(robot.marker.marker_id)
    return missing


def _near(
    pixels: NDArray[np.uint8], floor: FloorMap, robot: MarkedRobot, hint: Detection, reach: float
) -> list[Sighting]:
    """Detect markers in windows around their places in a neighbouring photograph.

    A floor marker may have moved by 0.4 of its size, the robot's by `reach`; both by 8 px more.
    Markers that `hint` does not show are not searched.
    """
    size = (pixels.shape[1], pixels.shape[0])
    places = [(floor.dictionary, key, corners, 0.4) for key, corners in hint.floor.pixels.items()]
    if hint.robot is not None:
        marker = robot.marker
        places.append((marker.dictionary, marker.marker_id, hint.robot.corners_px, reach))
    found: list[Sighting] = []
    for dictionary, key, corners, sides in places:
        if isinstance(key, int):
            side = float(np.ptp(corners, axis=0).max())
            region = neighbourhood(corners, size, reach=sides * side + 8)
            found += find_markers(pixels, dictionary, wanted=[key], region=region)
    return found


def _no_floor(pixels: NDArray[np.uint8], floor: FloorMap) -> str:
    """Say that no floor marker is seen, and which other dictionary's markers are, if any."""
    expected = ", ".join(str(number) for number in floor.marker_ids)
    message = f"none of the floor's markers ({expected} of '{floor.dictionary}') is seen"
    other = guess_dictionary(pixels)
    if other is not None and other != floor.dictionary.lower():
        return f"{message}; the picture has markers of '{other}': correct dictionary in floor.toml"
    return f"{message}; check their numbers, and that they lie flat, unshaded and inside"


def observe(
    fit: FloorFit, detections: Sequence[Detection], *, robot: MarkedRobot,
    times: Mapping[str, tuple[float, float]], edge_sd: float | None = None,
) -> tuple[PoseObservation, ...]:  # fmt: skip
    """Compute the robot's pose in every photograph that shows its marker and the floor.

    The covariance of the corners is multiplied by `fit.noise_factor`², and includes the spread of
    the edges of single markers that the floor's markers show.

    Args:
        fit: The camera, its poses and the floor.
        detections: Markers detected in each photograph.
        robot: The robot's marker and prior.
        times: By photograph, time and its standard deviation [s]; needed for each observation.
        edge_sd: Standard deviation of the edges of one marker [px]; None for that of `fit`.

    Returns:
        One observation for each photograph that shows the robot's marker and for which `fit` has
        a camera pose, in the order of `detections`.

    Raises:
        ValueError: The line of sight to a corner of the robot's marker does not meet the plane of
            its expected height.
        KeyError: `times` lacks a photograph of which an observation is made.
    """
    return tuple(
        _observation(fit, detection.photo, detection.robot, robot, times, edge_sd)
        for detection in detections
        if detection.robot is not None and detection.photo not in fit.unused
    )


def _observation(
    fit: FloorFit, photo: str, sighting: Sighting, robot: MarkedRobot,
    times: Mapping[str, tuple[float, float]], edge_sd: float | None,
) -> PoseObservation:  # fmt: skip
    """Compute the robot's pose in one photograph; arguments as of `observe`."""
    pose = pose_of_marker(fit, fit.pose_of(photo), sighting, robot, edge_sd=edge_sd)
    t, t_sd = times[photo]
    return PoseObservation(photo, t, t_sd, pose, sighting.score, "marker", fit.stand_of(photo))


def pose_of_marker(
    fit: FloorFit, view: CameraPose, sighting: Sighting, robot: MarkedRobot, *,
    edge_sd: float | None = None,
) -> BodyPose:  # fmt: skip
    """Fit the robot's pose to its marker in a photograph.

    Args:
        fit: The camera and the edges of markers.
        view: Pose of the camera in the photograph.
        sighting: The robot's marker in the photograph.
        robot: The robot's marker and prior.
        edge_sd: Standard deviation of the edges of one marker [px]; None for that of `fit`.

    Raises:
        ValueError: The line of sight to a corner does not meet the plane of its expected height.
    """
    edge_sd = fit.edge_spread.sd if edge_sd is None else edge_sd
    # What makes a black square larger makes a white one smaller.
    floor, own = (
        marker_family(of).is_reversed for of in (fit.floor.dictionary, robot.marker.dictionary)
    )
    growth = edge_growth(sighting.corners_px).ravel()
    height = robot.prior.height + robot.marker.position[2]
    about = to_floor(fit.camera, view, sighting.corners_px, height)
    points = np.column_stack((about, np.full(len(about), height)))
    by_edges = fit.edge_derivative(sighting.corners_px, points, view) * (1 if floor == own else -1)
    spread = fit.noise_factor**2 * sighting.covariance
    return fit_pose(
        fit.camera,
        view,
        points_body=robot.marker.points_body,
        corners_px=sighting.corners_px - by_edges @ fit.edges,
        covariance=spread + edge_sd**2 * np.outer(growth, growth),
        prior=robot.prior,
        points_by=robot.marker.derivatives_at(robot.marker.points_body),
        pixels_by={EDGES: by_edges},
    )
