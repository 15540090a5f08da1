# SPDX-License-Identifier: MIT
"""What is no picture of a robot is refused."""

import numpy as np
import pytest

from support.drawn_plate import LENS, PLATE, VIEW, annotated, picture_of
from tracking.body import TopPlate, make_template
from tracking.errors import BodyError


def test_a_robot_cut_by_the_edge_is_no_template():
    rng = np.random.default_rng(3)
    with pytest.raises(BodyError, match="cut by the edge"):
        make_template(
            picture_of((1.0, 0.0, 0.0), rng), LENS, VIEW, pose=annotated((1.0, 0.0, 0.0)),
            plate=PLATE,
        )  # fmt: skip


def test_a_picture_without_contrast_is_no_template():
    with pytest.raises(BodyError, match="grey levels"):
        make_template(
            np.full((480, 640, 3), 90, np.uint8), LENS, VIEW, pose=annotated((0, 0, 0)), plate=PLATE
        )


def test_a_plate_without_sides_is_refused():
    with pytest.raises(BodyError, match="above 0 m"):
        TopPlate(0.2, 0.0, 0.03)
