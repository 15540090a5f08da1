# SPDX-License-Identifier: MIT
"""Tracks of simulated walks from their corners: of a marked robot, and of one clicked on."""

from dataclasses import replace

import numpy as np

from support.drawn_walks import TOP_HEIGHT, DrawnWalk, places_on_top, top_in_photo
from tracking.body import Alignment, AnnotatedPose, TopPlate
from tracking.body.align import SCALE_SD
from tracking.camera import Camera, CameraPose, project
from tracking.detect import Detection, MarkedRobot, RobotMarker, observe
from tracking.floor import FloorMap, FloorMarker, FloorView, refine_floor
from tracking.markers import Sighting
from tracking.photos.by_look import nearest_of, pose_of_top
from tracking.photos.by_marker import edge_spread
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.result import Times, Tracked, finish, observation_of, shared_errors
from tracking.photos.scene import MarkedTop, Scene
from tracking.pose import BodyPose, BodyPrior, body_to_floor, fit_pose

OUTLINE_SD = 0.15
"""Standard deviation of a corner of the robot's outline as found again [px]."""
CLICK_SD = 0.5
"""Standard deviation of a click [px]."""
PLATE = TopPlate(0.176, 0.176, TOP_HEIGHT)


def photographed(walk: DrawnWalk) -> tuple[Scene, FloorSeen, Times]:
    """Return what the lab is told of a drawn walk, the fitted floor, and times of photographs."""
    s, told = walk.spreads, walk.told
    fx, fy, cx, cy, *distortion = told.lens
    camera = Camera(
        walk.size, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]]), np.array(distortion),
        np.diag(np.square(walk.lens.sd)),
    )  # fmt: skip
    floor = FloorMap("4x4_50", tuple(
        FloorMarker(number, side, x, y, yaw, position_sd=s.tape, yaw_sd=s.mark_turn,
                    side_sd=s.mark_side)
        for number, (x, y, yaw, side) in told.marks.items()
    ))  # fmt: skip
    side, ahead, left, turn = told.robot
    prior = BodyPrior(told.height, s.bounce, s.tilt, s.height, s.tilt)
    robot = MarkedRobot(
        RobotMarker(0, side, "4x4_50", (ahead, left, 0.0385), turn - np.pi / 2, s.side, s.place,
                    s.turn),
        prior,
    )  # fmt: skip
    names = [f"p{k}.jpg" for k in range(len(walk.t))]
    detections = [
        Detection(
            name,
            FloorView(name, {key: each.corners for key, each in floor_seen.items()},
                      {key: each.covariance for key, each in floor_seen.items()}),
            Sighting(0, marker.corners, marker.covariance, 1.0, 0.8),
        )
        for name, floor_seen, marker in zip(names, walk.floor, walk.robot, strict=True)
    ]  # fmt: skip
    fit = refine_floor(camera, floor, [each.floor for each in detections])
    times = {name: (float(t), 0.0) for name, t in zip(names, walk.t, strict=True)}
    return Scene(camera, floor, prior, robot), FloorSeen(fit, tuple(detections), {}), times


def track_marked(walk: DrawnWalk) -> Tracked:
    """Track a drawn walk from its corners, told what the lab was told."""
    scene, seen, times = photographed(walk)
    fit, detections, robot = seen.fit, seen.detections, scene.robot
    assert robot is not None
    edges = edge_spread(
        fit, detections, robot=robot, times=times, shared=shared_errors(scene, seen), gap=None
    )
    observations = observe(fit, detections, robot=robot, times=times, edge_sd=edges.sd)
    return finish(scene, seen, observations, unseen={}, times=times, gap=None)


def track_unmarked(walk: DrawnWalk, rng: np.random.Generator, annotated: int = 1) -> Tracked:
    """Track a drawn walk by the outline of its top, clicked on in some of the photographs.

    Args:
        walk: The walk.
        rng: Source of randomness of clicks and outlines.
        annotated: Number of photographs clicked on, spread over the walk from the first.
    """
    scene, seen, times = photographed(walk)
    scene = replace(scene, camera=seen.fit.camera, robot=None)
    names = list(times)
    numbers = _clicked_on(len(names), annotated)
    clicked = {names[k]: _clicked(walk, k, scene, seen, rng) for k in numbers}
    nearest = nearest_of(names, list(clicked))
    observations, again = [], []
    for k, name in enumerate(names):
        sought = list(clicked) if name in clicked else [nearest[name]]
        for annotated_in in sought:
            pose, places = clicked[annotated_in]
            found = _found(walk, k, places, pose, seen.fit.pose_of(name), rng)
            observation = observation_of(
                name, Alignment(found, 1.0, 0.0), times[name], source="body",
                annotated=(annotated_in, pose),
            )  # fmt: skip
            (observations if annotated_in == nearest[name] else again).append(observation)
    return finish(
        scene, seen, observations, unseen={}, times=times, gap=None, again=again,
        annotations={name: pose for name, (pose, _) in clicked.items()},
    )  # fmt: skip


def _clicked_on(photos: int, annotated: int) -> list[int]:
    """Choose the numbers of the photographs to annotate, spread over the walk from the first."""
    return np.linspace(0, photos, annotated, endpoint=False).astype(int).tolist()


def _found(
    walk: DrawnWalk, photo: int, places: np.ndarray, annotated: AnnotatedPose, view: CameraPose,
    rng: np.random.Generator,
) -> BodyPose:  # fmt: skip
    """Find places of the robot's top in a photograph, and the pose that follows from a template."""
    pixels = top_in_photo(walk, photo, places)
    larger = (pixels - pixels.mean(axis=0)).ravel()
    covariance = OUTLINE_SD**2 * np.eye(8) + SCALE_SD**2 * np.outer(larger, larger)
    pixels = pixels + rng.multivariate_normal(np.zeros(8), covariance).reshape(4, 2)
    return fit_pose(
        annotated.camera, view, points_body=PLATE.corners_body, corners_px=pixels,
        covariance=covariance, prior=annotated.prior,
        points_by=annotated.points_by(PLATE.corners_body),
    )  # fmt: skip


def _clicked(
    walk: DrawnWalk, photo: int, scene: Scene, seen: FloorSeen, rng: np.random.Generator
) -> tuple[AnnotatedPose, np.ndarray]:
    """Click on the top's corners: the pose fitted, and what its outline shows, in the body frame.

    The latter is x and y of four places, shape (4, 2) [m].
    """
    name = f"p{photo}.jpg"
    clean = top_in_photo(walk, photo, np.asarray(PLATE.corners_body[:, :2], dtype=np.float64))
    clicks = clean + CLICK_SD * rng.standard_normal((4, 2))
    top = MarkedTop(name, tuple((u, v) for u, v in clicks.tolist()), PLATE, CLICK_SD)
    annotated = pose_of_top(top, scene, seen.fit.pose_of(name))
    corners = body_to_floor(PLATE.corners_body, annotated.pose.state)
    outline = np.asarray(project(scene.camera, seen.fit.pose_of(name), corners), np.float64)
    return annotated, places_on_top(walk, photo, outline)
