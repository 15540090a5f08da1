# SPDX-License-Identifier: MIT
"""Whether a track's errors are as large as its covariances say, on simulated walks.

    python -m benchmarks.accuracy.tracked_walks 400
    python -m benchmarks.accuracy.tracked_walks 400 --unmarked 1 3

Walks are drawn by `benchmarks.accuracy.drawn_walks`, whose code is not the tracker's: every value
that the tracker is told has an error of the standard deviation that is told with it. SIMULATED:
corners, not pictures. Printed are, over all walks, the squared error by the covariance divided by
its degrees of freedom (NEES) of single poses and of all poses of a walk jointly, with 99 %
intervals from a bootstrap over walks, how often 90 % intervals of the last pose hold the truth, and
its median standard deviations, also as a multiple of those of an estimator told all true
covariances (`drawn_walks.bound`).

With `--unmarked` the robot has no marker: a person clicks on the corners of its top in one or more
photographs, and what lies there is found again in the others, with errors of `OUTLINE_SD` and of
its size; the outlines are drawn, the search for them in pictures is not part of this table, nor
is the refinement of clicks by the edges of the top.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.stats import binom

from benchmarks.accuracy.drawn_walks.bound import Clicks, least_sd
from benchmarks.accuracy.drawn_walks.world import (
    PLAIN,
    TOP_HEIGHT,
    WIDE,
    DrawnWalk,
    Lens,
    Spreads,
    draw_walk,
    places_on_top,
    top_in_photo,
)
from benchmarks.tables import print_table
from tracking.body import Alignment, AnnotatedPose, TopPlate
from tracking.body.align import SCALE_SD
from tracking.camera import Camera, CameraPose, project
from tracking.detect import Detection, MarkedRobot, observe
from tracking.floor import EDGE_SPREADS, FloorMap, FloorMarker, FloorView, refine_floor
from tracking.floor.adjustment import EDGE_SCALE
from tracking.markers import Sighting
from tracking.next_annotation import next_annotation
from tracking.path import Track
from tracking.photos.by_look import nearest_of, pose_of_top
from tracking.photos.edges import edge_spread
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.result import Times, Tracked, finish, observation_of, shared_errors
from tracking.photos.scene import MarkedTop, Scene
from tracking.pose import BodyPose, BodyPrior, RobotMarker, body_to_floor, fit_pose

DISTANCES = (2.0, 2.6, 3.4, 4.4, 5.7)  # m
EDGES = (None, 0.0, 0.03, 0.06)
"""Spread of edges of the rows [px]; None for one of each walk, drawn from the tracker's prior."""
OUTLINE_SD = 0.15
"""Standard deviation of a corner of the robot's outline as found again [px]."""
CLICK_SD = 0.5
"""Standard deviation of a click [px]."""
PLATE = TopPlate(0.176, 0.176, TOP_HEIGHT)
NEAR = 3.4  # m, the farthest distance that counts as near


@dataclass(frozen=True)
class Scored:
    """Errors of one walk by its covariances.

    Attributes:
        distance: Distance of the camera [m].
        marginal: NEES over its degrees of freedom, mean of the poses [-].
        joint: NEES of all poses together over its degrees of freedom [-].
        last: Error of the last pose over its standard deviation, x, y and yaw, shape (3,) [-].
        sd: Standard deviation of the last pose, shape (3,) [m, m, rad].
        least_sd: What `sd` would be of an estimator told all true covariances, shape (3,).
        largest: Largest distance from the truth [m].
    """

    distance: float
    marginal: float
    joint: float
    last: np.ndarray
    sd: np.ndarray
    least_sd: np.ndarray
    largest: float


class Job(NamedTuple):
    """A walk to draw and track."""

    seed: int
    lens: Lens
    distance: float
    spreads: Spreads
    annotated: int = 0  # photographs clicked on; 0: the robot has a marker


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


def track_drawn(walk: DrawnWalk) -> Track:
    """Track a drawn walk from its corners, told what the lab was told."""
    return track_drawn_whole(walk).track


def track_drawn_whole(walk: DrawnWalk) -> Tracked:
    """Track a drawn walk as `track_drawn` does, and return what is said of it too."""
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
    tracked = finish(
        scene, seen, observations, unseen={}, times=times, gap=None, again=again,
        annotations={name: pose for name, (pose, _) in clicked.items()},
    )  # fmt: skip
    suggested = next_annotation(
        tracked.track, {name: seen.fit.pose_of(name) for name in names}, camera=scene.camera,
        prior=scene.prior, plate=PLATE, corner_sd_px=CLICK_SD, annotated=clicked,
    )  # fmt: skip
    return replace(tracked, next_annotation=suggested)


def _clicked_on(photos: int, annotated: int) -> list[int]:
    """Choose the numbers of the photographs to annotate, spread over the walk from the first."""
    return np.linspace(0, photos, annotated, endpoint=False).astype(int).tolist()


def _clicks(photos: int, annotated: int) -> Clicks:
    """Return what is seen of a robot without a marker, for the least standard deviation."""
    names = [f"p{k}.jpg" for k in range(photos)]
    numbers = _clicked_on(photos, annotated)
    nearest = nearest_of(names, [names[k] for k in numbers])
    found = [
        (k, a) for k in range(photos)
        for a in (numbers if k in numbers else [names.index(nearest[names[k]])])
    ]  # fmt: skip
    corners = np.asarray(PLATE.corners_body[:, :2], np.float64)
    return Clicks(corners, CLICK_SD, OUTLINE_SD, SCALE_SD, found)


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


def score(job: Job) -> Scored:
    """Draw and track a walk, and compare it with the truth."""
    rng = np.random.default_rng(job.seed)
    walk = draw_walk(rng, lens=job.lens, distance=job.distance, spreads=job.spreads)
    track = track_unmarked(walk, rng, job.annotated).track if job.annotated else track_drawn(walk)
    distance = job.distance
    error = track.poses - walk.poses
    error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
    n, covariance = len(error), track.covariance
    marginal = np.einsum("ni,nij,nj->n", error, np.linalg.inv(covariance), error).mean() / 3
    dense = track.joint.dense
    flat = error.ravel()
    joint = float(flat @ np.linalg.solve(dense, flat)) / (3 * n)
    sd = np.sqrt(np.diag(covariance[-1]))
    largest = float(np.hypot(*error[:, :2].T).max())
    clicks = _clicks(n, job.annotated) if job.annotated else None
    return Scored(
        distance, float(marginal), joint, error[-1] / sd, sd, least_sd(walk, clicks), largest
    )


def jobs(walks: int, edges: float | None, *, annotated: int = 0) -> list[Job]:
    """List the walks to draw: both lenses and all distances in turn."""
    kinds = list(product((PLAIN, WIDE), DISTANCES))
    rng = np.random.default_rng(7)
    return [
        Job(1000 + k, *kinds[k % len(kinds)],
            replace(Spreads(), edges=_drawn_spread(rng) if edges is None else edges), annotated)
        for k in range(walks)
    ]  # fmt: skip


def _drawn_spread(rng: np.random.Generator) -> float:
    """Draw a spread of edges from the half-Cauchy prior within `EDGE_SPREADS` [px]."""
    low, high = np.arctan(EDGE_SPREADS[[0, -1]] / EDGE_SCALE)
    return float(EDGE_SCALE * np.tan(rng.uniform(low, high)))


def interval(values: np.ndarray, rng: np.random.Generator) -> tuple[float, float]:
    """Compute the 99 % interval of the mean by a bootstrap over walks."""
    means = values[rng.integers(0, len(values), (4000, len(values)))].mean(axis=1)
    low, high = np.quantile(means, [0.005, 0.995])
    return float(low), float(high)


def main() -> None:
    """Draw walks, track them and print the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n")[0])
    parser.add_argument("walks", type=int, nargs="?", default=400)
    parser.add_argument(
        "--unmarked", type=int, nargs="*", help="robots without a marker: photographs annotated"
    )
    asked = parser.parse_args()
    kinds = [(edges, 0) for edges in EDGES]
    if asked.unmarked is not None:
        kinds = [(0.03, annotated) for annotated in asked.unmarked or [1]]
    rng = np.random.default_rng(0)
    rows = []
    with ProcessPoolExecutor() as pool:
        for edges, annotated in kinds:
            drawn = jobs(asked.walks, edges, annotated=annotated)
            scored = list(pool.map(score, drawn, chunksize=4))
            name = "drawn edges" if edges is None else f"edges {edges:g} px"
            if annotated:
                name = f"no marker, {annotated} annotated"
            rows.append((name, *_row(scored, rng)))
    print_table(
        ("walks", "NEES", "99 %", "joint NEES", "99 %", "near: x, y, yaw hold", "far", "of",
         "sd x, y, yaw", "of the least", "largest error"),
        *rows,
    )  # fmt: skip


def _row(scored: list[Scored], rng: np.random.Generator) -> tuple[str, ...]:
    cells = []
    for values in (np.array([s.marginal for s in scored]), np.array([s.joint for s in scored])):
        low, high = interval(values, rng)
        cells += [f"{values.mean():.3f}", f"{low:.3f} to {high:.3f}"]
    near = [s for s in scored if s.distance <= NEAR]
    far = [s for s in scored if s.distance > NEAR]
    for group in (near, far):
        held = (np.abs([s.last for s in group]) < 1.6448536).sum(axis=0)
        low, high = binom.interval(1 - 0.01 / 18, len(group), 0.9)
        cells.append(f"{held[0]}, {held[1]}, {held[2]} in {low:.0f} to {high:.0f}")
    cells.append(f"{len(near)} + {len(far)}")
    sd = np.median([s.sd for s in scored], axis=0)
    cells.append(f"{1e3 * sd[0]:.2f} mm, {1e3 * sd[1]:.2f} mm, {np.degrees(sd[2]):.3f}°")
    least = np.median([s.least_sd for s in scored], axis=0)
    cells.append(", ".join(f"{each:.2f}" for each in sd / least))
    cells.append(f"{1e3 * max(s.largest for s in scored):.1f} mm")
    return tuple(cells)


if __name__ == "__main__":
    main()
