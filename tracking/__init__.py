# SPDX-License-Identifier: MIT
"""Robot tracking: the path of a walk from photographs."""

from tracking.path import Track
from tracking.photos import MarkedTop, Photo, Scene, Tracked, track_photos

__all__ = ["MarkedTop", "Photo", "Scene", "Track", "Tracked", "track_photos"]
