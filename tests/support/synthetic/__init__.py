# SPDX-License-Identifier: MIT
"""Simulated photographs with known truth; shares no code with the code under test.

Rendered by inverse mapping (ray casting): each pixel is the mean over rays through its square, each
traced back through the lens to the floor, a print or the robot.
"""

from support.synthetic.composite import composite
from support.synthetic.lens import SyntheticCamera, look_at
from support.synthetic.patterns import charuco_cells, checkerboard_cells, marker_cells
from support.synthetic.photograph import (
    HARSH,
    IDEAL,
    Conditions,
    SyntheticPhoto,
    develop,
    take_photo,
)
from support.synthetic.robot import (
    DrawnPose,
    DrawnRobotMarker,
    RobotLook,
    RobotState,
    marker_corners,
)
from support.synthetic.scene import (
    DrawnFloorMarker,
    DrawnScene,
    Light,
    Sheet,
    paint_sheets,
    render_background,
)
from support.synthetic.stamp import with_time_stamp

__all__ = [
    "HARSH",
    "IDEAL",
    "Conditions",
    "DrawnFloorMarker",
    "DrawnPose",
    "DrawnRobotMarker",
    "DrawnScene",
    "Light",
    "RobotLook",
    "RobotState",
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
