# SPDX-License-Identifier: MIT
"""Track a robot in the photographs of a walk: poses with covariance, smoothed to a path."""

from tracking.photos.result import Tracked
from tracking.photos.scene import MarkedTop, Photo, Scene
from tracking.photos.track import track_photos

__all__ = ["MarkedTop", "Photo", "Scene", "Tracked", "track_photos"]
