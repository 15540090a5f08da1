# SPDX-License-Identifier: MIT
"""Camera poses and floor marks fitted to all photographs of a walk."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from model.arrays import Array
from tracking.camera.lens import Camera, CameraPose
from tracking.errors import FloorError
from tracking.floor.adjustment import Adjustment
from tracking.floor.doubt import REMARKABLE, SuspectValue, doubts, suspicion
from tracking.floor.edge_spread import EdgeSpread
from tracking.floor.locate import FloorView, locate_camera, seen_keys
from tracking.floor.marks import FloorMap
from tracking.shared import SharedErrors, stand_name

JUMP_PX = 0.2
"""Least shift of the floor's marks, beyond 3 standard deviations, that counts as movement [px]."""


def split_stands(views: Sequence[FloorView], *, jump_px: float = JUMP_PX) -> tuple[int, ...]:
    """Number the stands: stretches of photographs between which the camera moved.

    A rotation by 0.05 degrees moves the floor by 1 px in a usual picture and the path by 2 mm. So
    the median shift of the marks from their mean in the stand so far is compared with their noise.

    Args:
        views: Pixels of the floor's marks in each photograph, in order of time.
        jump_px: Least shift, beyond 3 standard deviations, that counts as movement [px].

    Returns:
        For every photograph the number of its stand, from 0. A photograph without marks, or
        without a mark in common with the stand before it, belongs to that stand.
    """
    stands: list[int] = []
    current: list[FloorView] = []
    number = 0
    for view in views:
        if current and _has_moved(current, view, jump_px):
            number += 1
            current = []
        if view.pixels:
            current.append(view)
        stands.append(number)
    return tuple(stands)


def _has_moved(stand: Sequence[FloorView], view: FloorView, jump_px: float) -> bool:
    """Return whether the camera has moved since a stand: by the marks' shift from their means.

    The median shift of all points must exceed `jump_px` plus 3 median standard deviations of a
    shift [px]. Without a mark in common it has not.
    """
    shifts, noises = [], []
    for key, pixels in view.pixels.items():
        before = [np.asarray(other.pixels[key]) for other in stand if key in other.pixels]
        if before:
            shifts.append((pixels - np.mean(before, axis=0)).ravel())
            noises.append(np.diag(view.covariances[key]) * (1 + 1 / len(before)))
    if not shifts:
        return False
    return _typical(np.concatenate(shifts)) > jump_px + 3 * float(
        np.sqrt(np.median(np.concatenate(noises)))
    )


def _typical(shift: Array) -> float:
    """Compute the median length of shifts, given as raveled u, v of each point [px]."""
    # The median over points: a mark that is half hidden by a leg must not count as a movement.
    return float(np.median(np.linalg.norm(shift.reshape(-1, 2), axis=1)))


@dataclass(frozen=True)
class Stand:
    """Consecutive photographs during which the camera did not move.

    Attributes:
        pose: Pose of the camera; its covariance includes the tape measure's errors.
        photos: Names of those photographs that show a mark of the floor, in order of time.
    """

    pose: CameraPose
    photos: tuple[str, ...]


@dataclass(frozen=True)
class FloorFit:
    """The floor and the camera, fitted to all photographs, with residual statistics.

    Attributes:
        floor: The map with refined x, y, yaw and side of the marks; marks that no photograph shows
            are as measured.
        stands: One entry for each stretch of photographs with the camera at rest.
        shifts: By key of each mark, x and y of its refined minus its measured centre, shape (2,)
            [m].
        misfit_px: Root mean square distance of the marks' points, medians over the photographs of
            a stand, from their projection [px].
        noise_factor: Pixel residuals over their standard deviations by the marks' covariances, 1
            where the excess is not significant; the poses' covariances include the factor [-].
        tape_factor: The same ratio, used likewise, of the marks' changes in x, y, yaw and side to
            the standard deviations of their measurement [-].
        unused: By name of photograph, why it has no camera pose: it shows no mark of the floor.
        camera: The camera with its lens as fitted.
        edges: How far the edges of all markers lie outwards in the pictures, see
            `tracking.floor.adjustment.Adjusted`, shape (2,) [px].
        edge_derivative: Function from corners of a marker in a picture (4, 2), the same in the
            floor frame (4, 3) and the camera's pose to the movement of the corners by `edges`,
            shape (4, 2, 2).
        edge_spread: Standard deviation of the edges of one marker about `edges`, as far as the
            floor's markers tell.
        shared: Joint covariance of the errors of lens, camera poses, marks and edges.
        find_suspects: Compares alternatives in which a stated value of floor or lens is far off
            (`tracking.floor.doubt`); takes longer than the fit.
    """

    floor: FloorMap
    stands: tuple[Stand, ...]
    shifts: Mapping[int | str, Array]
    misfit_px: float
    noise_factor: float
    tape_factor: float
    unused: Mapping[str, str]
    camera: Camera
    edges: Array
    edge_derivative: Callable[[Array, Array, CameraPose], Array]
    edge_spread: EdgeSpread
    shared: SharedErrors
    find_suspects: Callable[[], tuple[SuspectValue, ...]]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, one sentence each: camera moved; a stated value that does not fit."""
        messages = [
            f"the camera moved between {a.photos[-1]} and {b.photos[0]}; photographs before and "
            f"after have different camera poses"
            for a, b in zip(self.stands, self.stands[1:], strict=False)
        ]
        return (*messages, *self.suspicion)

    @cached_property
    def suspicion(self) -> tuple[str, ...]:
        """Name the stated value of floor or lens that does not fit; empty if all do."""
        return suspicion(self.find_suspects(), remarkable=REMARKABLE)

    def pose_of(self, photo: str) -> CameraPose:
        """Return the camera's pose in the stand of a photograph, by the photograph's name.

        Raises:
            FloorError: When the photograph shows no mark or was not among those fitted.
        """
        return self.stands[self.stand_of(photo)].pose

    def stand_of(self, photo: str) -> int:
        """Return the number, from 0, of the stand of a photograph, by the photograph's name.

        Raises:
            FloorError: When the photograph shows no mark or was not among those fitted.
        """
        for index, stand in enumerate(self.stands):
            if photo in stand.photos:
                return index
        raise FloorError(f"{photo}: {self.unused.get(photo, 'not among the photographs fitted')}")


def refine_floor(camera: Camera, floor: FloorMap, views: Sequence[FloorView]) -> FloorFit:
    """Fit camera poses and mark positions to all photographs at once (bundle adjustment).

    Args:
        camera: Camera intrinsics and distortion.
        floor: The map as measured with a tape measure.
        views: Pixels of the floor's marks in each photograph, in order of time.

    Returns:
        Refined map, a camera pose with covariance for each stand, residuals, unused photographs.

    Raises:
        FloorError: When no photograph shows a mark, or a stand fewer than 4 points, or the map
            does not fit one (see `locate_camera`).
    """
    usable = [view for view in views if seen_keys(floor, view)]
    unused = {view.photo: "no mark of the floor is seen" for view in views if view not in usable}
    if not usable:
        raise FloorError(
            f"none of the {len(views)} photographs shows a mark of the floor "
            f"({', '.join(map(str, floor.marks))}); check the numbers and dictionary "
            f"'{floor.dictionary}' in floor.toml, or click on points of the floor"
        )
    numbers = split_stands(usable)
    groups = [
        [view for view, number in zip(usable, numbers, strict=True) if number == index]
        for index in range(max(numbers) + 1)
    ]
    means = [_mean_view(group) for group in groups]
    starts = [locate_camera(camera, floor, view) for view in means]
    problem = Adjustment(camera, floor, means, starts)
    edge_spread = problem.edges()
    problem = replace(problem, edge_sd=edge_spread.sd)
    found, factors = problem.solve()
    shared = problem.shared_errors(found, factors)
    stands = tuple(
        Stand(
            CameraPose(
                pose.rotation_vector,
                pose.translation,
                shared.covariance[(slot := shared.slots[stand_name(index)]), slot],
            ),
            tuple(view.photo for view in group),
        )
        for index, (pose, group) in enumerate(zip(found.poses, groups, strict=True))
    )
    fitted = found.floor
    shifts = {
        key: np.subtract(fitted.marks[key].points[:, :2].mean(0), mark.points[:, :2].mean(0))
        for key, mark in floor.marks.items()
    }
    return FloorFit(
        fitted, stands, shifts, problem.misfit(found), *factors, unused, problem.lens(found),
        found.edges, problem.edge_derivative, edge_spread, shared, partial(doubts, problem, found),
    )  # fmt: skip


def _mean_view(views: Sequence[FloorView]) -> FloorView:
    """Compute the median pixels and mean covariance of each mark over a stand's photographs.

    The view has the name of the first photograph.
    """
    pixels: dict[int | str, Array] = {}
    covariances: dict[int | str, Array] = {}
    for key in {key: None for view in views for key in view.pixels}:
        seen = [view for view in views if key in view.pixels]
        # The median is robust to a photograph in which the robot covers a corner. The covariance is
        # not divided by the number of photographs: errors of print and lens are common to all.
        pixels[key] = np.median([view.pixels[key] for view in seen], axis=0)
        covariances[key] = np.mean([view.covariances[key] for view in seen], axis=0)
    return FloorView(views[0].photo, pixels, covariances)
