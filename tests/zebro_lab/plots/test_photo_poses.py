# SPDX-License-Identifier: MIT
"""Robots and paths are drawn where they were predicted and seen."""

import numpy as np

from model.robot import Robot
from zebro_lab.plots.photo_poses import Shot, photos_beside_poses


def test_a_robot_is_drawn_where_it_was_predicted(walked):
    orientation = np.array([0.0, 0.0, 0.5])
    shot = Shot(
        t=1.0, picture=np.zeros((4, 4, 3), np.uint8), extent=(0.0, 1.0, 0.0, 1.0),
        tracked=np.array([0.5, 0.4, 0.4]), position=np.array([0.5, 0.43, 0.06]),
        orientation=orientation, theta=walked.theta[0], contact=walked.contact[0],
    )  # fmt: skip
    figure = photos_beside_poses([shot], Robot(), title="w", simulated_photos=False)
    above, below = figure.axes
    assert "off 30 mm, +5.7 deg" in below.get_title(loc="left")
    assert above.get_ylabel().startswith("photograph")
    lines = {line.get_label(): line for line in below.lines}
    assert {"predicted body", "tracked body", "leg on the ground", "leg in the air"} <= set(lines)
    for label, middle in (("predicted body", [0.5, 0.43]), ("tracked body", [0.5, 0.4])):
        rear_and_front = lines[label].get_xydata()[[0, 1, 2, 4]]  # without the tip
        np.testing.assert_allclose(rear_and_front.mean(axis=0), middle, atol=1e-6)
