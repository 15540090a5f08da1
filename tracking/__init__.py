# SPDX-License-Identifier: MIT
"""Photographs in, walked path out."""

from tracking.path import Track
from tracking.photos import MarkedTop, Photo, Scene, Tracked, track_photos

__all__ = ["MarkedTop", "Photo", "Scene", "Track", "Tracked", "track_photos"]
