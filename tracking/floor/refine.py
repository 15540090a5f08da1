# SPDX-License-Identifier: MIT
"""Camera and floor together: every stand of the camera and every mark, weighed by the tape.

The unknowns are a camera pose a stand (6) and x, y, yaw and side of every mark (x, y of a point).
Minimised is

    sum over stands and marks  r' C^-1 r  +  sum over marks  ((m - m_tape) / sd_tape)²

where r is the mark's pixels minus its projection. The tape holds the frame: without it the floor
could be shifted, turned and stretched at will.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tracking.camera.lens import Array, Camera, CameraPose, project_with_derivatives
from tracking.errors import FloorError
from tracking.floor.locate import FloorView, locate_camera, seen_keys
from tracking.floor.marks import FloorMap
from tracking.floor.stands import split_stands


@dataclass(frozen=True)
class Stand:
    """A stretch of photographs during which the camera did not move.

    Attributes:
        pose: The camera, with a covariance that includes the tape's.
        photos: Names of the photographs.
    """

    pose: CameraPose
    photos: tuple[str, ...]


@dataclass(frozen=True)
class FloorFit:
    """The floor and the camera, fitted to all photographs.

    Attributes:
        floor: The map with refined positions.
        stands: One entry a stretch of photographs with the camera at rest.
        shifts: By mark, how far it is from where the tape had it, shape (2,) [m].
        misfit_px: Root mean square distance of marks from their projection [px].
        noise_factor: By how much residuals exceed what the marks' covariances promise, at least 1;
            squared, it has been multiplied into the poses' covariances [-].
        unused: Photographs that show no mark of the floor, with the reason.
    """

    floor: FloorMap
    stands: tuple[Stand, ...]
    shifts: Mapping[int | str, Array]
    misfit_px: float
    noise_factor: float
    unused: Mapping[str, str]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader of the result should know, one sentence each."""
        messages = [
            f"the camera moved between {a.photos[-1]} and {b.photos[0]}; each side has its own "
            f"camera pose"
            for a, b in zip(self.stands, self.stands[1:], strict=False)
        ]
        for key, shift in self.shifts.items():
            sd = self.floor.marks[key].position_sd
            if np.linalg.norm(shift) > 4 * sd:
                messages.append(
                    f"mark {key} lies {1e3 * float(np.linalg.norm(shift)):.1f} mm from where the "
                    f"tape has it (standard deviation {1e3 * sd:.1f} mm); measure it again"
                )
        return tuple(messages)

    def pose_of(self, photo: str) -> CameraPose:
        """Return the camera's pose for a photograph.

        Raises:
            FloorError: When the photograph has none.
        """
        for stand in self.stands:
            if photo in stand.photos:
                return stand.pose
        raise FloorError(f"{photo}: {self.unused.get(photo, 'not among the photographs fitted')}")


def refine_floor(camera: Camera, floor: FloorMap, views: Sequence[FloorView]) -> FloorFit:
    """Fit camera poses and mark positions to all photographs at once.

    Args:
        camera: The lens.
        floor: The map as measured with a tape.
        views: The floor's marks in each photograph, in order of time.

    Returns:
        Refined map, camera poses with covariance, and what did not fit.

    Raises:
        FloorError: When no photograph shows a mark, or the map does not fit (see `locate_camera`).
    """
    usable = [view for view in views if seen_keys(floor, view)]
    unused = {view.photo: "no mark of the floor is seen" for view in views if view not in usable}
    if not usable:
        raise FloorError(
            f"none of the {len(views)} photographs shows a mark of the floor; check the dictionary "
            f"('{floor.dictionary}') and the numbers {', '.join(map(str, floor.marks))}"
        )
    numbers = split_stands(usable)
    groups = [
        [view for view, number in zip(usable, numbers, strict=True) if number == index]
        for index in range(max(numbers) + 1)
    ]
    means = [_mean_view(group) for group in groups]
    starts = [locate_camera(camera, floor, view) for view in means]
    problem = _Problem(camera, floor, means)
    fitted, poses, covariance, misfit, factor = problem.solve(starts)
    stands = tuple(
        Stand(
            CameraPose(pose.rotation_vector, pose.translation, covariance[index]),
            tuple(view.photo for view in group),
        )
        for index, (pose, group) in enumerate(zip(poses, groups, strict=True))
    )
    shifts = {
        key: np.subtract(fitted.marks[key].points[:, :2].mean(0), mark.points[:, :2].mean(0))
        for key, mark in floor.marks.items()
    }
    return FloorFit(fitted, stands, shifts, misfit, factor, unused)


def _mean_view(views: Sequence[FloorView]) -> FloorView:
    """Average the marks over photographs with the camera at rest."""
    pixels: dict[int | str, Array] = {}
    covariances: dict[int | str, Array] = {}
    for key in {key: None for view in views for key in view.pixels}:
        seen = [view for view in views if key in view.pixels]
        # The median forgives a photograph in which the robot covers a corner; the covariance is
        # not divided by the number of photographs, since print and lens err alike in each.
        pixels[key] = np.median([view.pixels[key] for view in seen], axis=0)
        covariances[key] = np.mean([view.covariances[key] for view in seen], axis=0)
    return FloorView(views[0].photo, pixels, covariances)


@dataclass(frozen=True)
class _Problem:
    camera: Camera
    floor: FloorMap
    views: Sequence[FloorView]

    def solve(
        self, starts: Sequence[CameraPose]
    ) -> tuple[FloorMap, list[CameraPose], list[Array], float, float]:
        """Iterate Gauss-Newton; return map, poses, their covariances, misfit [px] and factor."""
        floor, poses = self.floor, list(starts)
        for _ in range(20):
            normal, gradient, cost, squares = self._system(floor, poses)
            step = np.linalg.solve(normal, gradient)
            floor, poses = self._moved(floor, poses, step)
            if step @ gradient < 1e-10 * max(cost, 1.0):
                break
        normal, _, cost, squares = self._system(floor, poses)
        pixels = sum(2 * len(view.pixels[key]) for view in self.views for key in view.pixels)
        freedom = max(pixels - 6 * len(poses), 1)
        factor = float(np.sqrt(max(1.0, cost / freedom)))
        covariance = np.linalg.inv(normal)
        blocks = [
            factor**2 * covariance[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] for i in range(len(poses))
        ]
        return floor, poses, blocks, float(np.sqrt(2 * squares / pixels)), factor

    def _slots(self) -> dict[int | str, slice]:
        start, slots = 6 * len(self.views), {}
        for key, mark in self.floor.marks.items():
            slots[key] = slice(start, start + len(mark.prior_sd))
            start += len(mark.prior_sd)
        return slots

    def _system(
        self, floor: FloorMap, poses: Sequence[CameraPose]
    ) -> tuple[Array, Array, float, float]:
        slots = self._slots()
        size = max(slot.stop for slot in slots.values())
        normal, gradient = np.zeros((size, size)), np.zeros(size)
        cost = squares = 0.0
        for index, (pose, view) in enumerate(zip(poses, self.views, strict=True)):
            for key in seen_keys(floor, view):
                mark = floor.marks[key]
                pixels, by_point, by_pose = project_with_derivatives(self.camera, pose, mark.points)
                J = np.zeros((2 * len(pixels), size))
                J[:, 6 * index : 6 * index + 6] = by_pose.reshape(-1, 6)
                J[:, slots[key]] = (by_point @ mark.derivative).reshape(2 * len(pixels), -1)
                r = (view.pixels[key] - pixels).ravel()
                weight = np.linalg.inv(view.covariances[key])
                normal += J.T @ weight @ J
                gradient += J.T @ weight @ r
                cost += float(r @ weight @ r)
                squares += float(r @ r)
        for key, slot in slots.items():
            weight = self.floor.marks[key].prior_sd ** -2
            pull = self._from_tape(floor, key)
            normal[slot, slot] += np.diag(weight)
            gradient[slot] -= weight * pull
            cost += float(weight @ pull**2)
        return normal, gradient, cost, squares

    def _from_tape(self, floor: FloorMap, key: int | str) -> Array:
        found, tape = floor.marks[key], self.floor.marks[key]
        names = ("x", "y", "yaw", "side")[: len(tape.prior_sd)]
        return np.array([getattr(found, name) - getattr(tape, name) for name in names])

    def _moved(
        self, floor: FloorMap, poses: Sequence[CameraPose], step: Array
    ) -> tuple[FloorMap, list[CameraPose]]:
        marks = {key: floor.marks[key].moved(step[slot]) for key, slot in self._slots().items()}
        moved = [
            CameraPose(
                pose.rotation_vector + step[6 * i : 6 * i + 3],
                pose.translation + step[6 * i + 3 : 6 * i + 6],
                pose.covariance,
            )
            for i, pose in enumerate(poses)
        ]
        return floor.with_marks(marks), moved
