# SPDX-License-Identifier: MIT
"""Simulated photographs with known truth; shares no code with what it is to test.

Rendered by inverse mapping: each pixel is the mean over rays through its square, each traced back
through the lens to the floor, a print or the robot.
"""

from tracking.synthetic.composite import CompositeKind, composite
from tracking.synthetic.lens import SyntheticCamera, look_at
from tracking.synthetic.patterns import charuco_cells, checkerboard_cells, marker_cells
from tracking.synthetic.photograph import (
    HARSH,
    IDEAL,
    Conditions,
    Glare,
    Shade,
    SyntheticPhoto,
    develop,
    take_photo,
)
from tracking.synthetic.robot import (
    BodyPose,
    RobotLook,
    RobotMarker,
    RobotState,
    marker_corners,
)
from tracking.synthetic.scene import (
    FloorMarker,
    Light,
    Scene,
    Sheet,
    paint_sheets,
    render_background,
)
from tracking.synthetic.stamp import with_time_stamp

__all__ = [
    "HARSH",
    "IDEAL",
    "BodyPose",
    "CompositeKind",
    "Conditions",
    "FloorMarker",
    "Glare",
    "Light",
    "RobotLook",
    "RobotMarker",
    "RobotState",
    "Scene",
    "Shade",
    "Sheet",
    "SyntheticCamera",
    "SyntheticPhoto",
    "charuco_cells",
    "checkerboard_cells",
    "composite",
    "develop",
    "look_at",
    "marker_cells",
    "marker_corners",
    "paint_sheets",
    "render_background",
    "take_photo",
    "with_time_stamp",
]
