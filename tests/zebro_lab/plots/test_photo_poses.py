# SPDX-License-Identifier: MIT
"""Robots and paths are drawn where they were predicted and seen."""

import numpy as np

from model.poses import Poses
from model.robot import Robot
from zebro_lab.plots.photo_poses import Shot, band_over_floor, photos_beside_poses


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


def test_paths_are_drawn_over_the_floor_to_its_scale(walked):
    path = walked.poses
    band = Poses(path.t, np.stack([path.position, path.position + 0.1]), np.stack([path.yaw] * 2))
    track = path.at([1.0, 2.0, 3.0])
    picture = np.full((20, 40, 3), 100, np.uint8)
    for draws, lines in ((band, 4), (None, 2)):
        figure = band_over_floor(
            picture, extent=(-1.0, 3.0, -0.5, 1.5), path=path, band=draws, track=track, title="w",
            photo_at=3.0, simulated_photos=True,
        )  # fmt: skip
        (axes,) = figure.axes
        assert len(axes.lines) == lines
        predicted, seen = axes.lines[-2:]
        np.testing.assert_array_equal(predicted.get_xydata(), path.position)
        np.testing.assert_array_equal(seen.get_xydata(), track.position)
        assert (axes.get_xlim(), axes.get_ylim()) == ((-1.0, 3.0), (-0.5, 1.5))
        assert axes.get_aspect() == 1.0
        assert "simulated" in figure.get_suptitle()
