# SPDX-License-Identifier: MIT
"""Inputs of tracking that are known beforehand: camera, floor, robot and annotations."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tracking.body import TopPlate
from tracking.camera import Camera
from tracking.corrections import Correction
from tracking.detect import MarkedRobot
from tracking.floor import FloorMap, FloorView
from tracking.pose import BodyPrior

Click = tuple[float, float]
"""A pixel that a person clicked on: column u and row v [px]."""


@dataclass(frozen=True)
class Photo:
    """A photograph, by name and file.

    Attributes:
        name: Name of the photograph in messages and results.
        path: Path of the picture file.
    """

    name: str
    path: Path


@dataclass(frozen=True)
class MarkedTop:
    """Annotation of the robot's top: its corners, clicked on in one photograph.

    Attributes:
        photo: Name of the photograph.
        corners_px: Clicks u, v on the front left, front right, rear right and rear left corner of
            the plate [px].
        plate: Dimensions of the robot's top.
        corner_sd_px: Standard deviation of u and of v of a click [px].
        edges: Whether edges of the top that are seen in the photograph refine the clicks.
    """

    photo: str
    corners_px: tuple[Click, ...]
    plate: TopPlate
    corner_sd_px: float = 0.5
    edges: bool = True


@dataclass(frozen=True)
class Scene:
    """Camera, floor, robot and annotations.

    Attributes:
        camera: Camera intrinsics and distortion, at the size of the photographs.
        floor: The floor's marks as measured.
        prior: Prior of the body's height and tilt.
        robot: The robot with its marker; None to track it by a template.
        tops: Annotations of the robot's top, each in another photograph, to track it by templates.
        clicks: By name of photograph and name of floor point, the pixel u, v clicked on [px].
        corrections: Manual corrections of the poses found, in the order in which they were made.
        is_composite: Whether there is one picture, into which the exposures of a walk were pasted.
        body_size: Length and width of the robot's body, needed for a composite picture [m].
    """

    camera: Camera
    floor: FloorMap
    prior: BodyPrior
    robot: MarkedRobot | None
    tops: tuple[MarkedTop, ...] = ()
    clicks: Mapping[str, Mapping[str, Click]] = field(default_factory=dict)
    corrections: tuple[Correction, ...] = ()
    is_composite: bool = False
    body_size: tuple[float, float] | None = None

    def with_clicks(self, view: FloorView) -> FloorView:
        """Return the view of a photograph with the scene's clicked floor points for it added.

        On a floor without markers, a photograph without clicks has those of the first with clicks.
        """
        clicks = self._clicks_for(view.photo)
        return view if not clicks else view.with_clicked(clicks)

    def _clicks_for(self, photo: str) -> Mapping[str, Click]:
        """Return the clicks of a photograph, by name of the floor point.

        On a floor without markers, a photograph without clicks has those of the first photograph
        with clicks: the camera is on a tripod. Elsewhere it has none; markers give the pose.
        """
        if photo in self.clicks or self.floor.markers or not self.clicks:
            return self.clicks.get(photo, {})
        return next(iter(self.clicks.values()))
