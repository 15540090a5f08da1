# SPDX-License-Identifier: MIT
"""An exposure is aligned with the one that is known, whatever lies on it."""

from dataclasses import replace

import numpy as np

from support.drawn_board import LENS, PRIOR, SIZE, TOP, VIEW, composite, likeness
from tracking.camera import project
from tracking.composite.known import disturbance_sd, strip_sd


def test_something_that_lies_on_a_robot_does_not_draw_it_where_odd_points_are_left_out():
    planar = np.array([0.0, 0.0, 0.3])
    clean = composite(planar[None])
    view = likeness(clean, planar, reach=0.3)
    seen = project(LENS, VIEW, np.array([[*planar[:2], PRIOR.height + TOP]]))[0].astype(int)
    covered = clean.copy()
    covered[seen[1] + 8 : seen[1] + 40, seen[0] - 60 : seen[0] + 8] = (20, 220, 220)

    def off(outlier_sd):
        found = replace(view, pixels=covered).aligned(
            planar, view.body_template(), ~view.hidden, least=0.0, outlier_sd=outlier_sd
        )
        return np.inf if found is None else np.hypot(*(found.pose.planar - planar)[:2])

    assert off(2.5) < 5e-4
    assert off(2.5) < 0.5 * off(np.inf)


def test_the_pixels_around_an_exposure_show_its_plane():
    planar = np.array([0.05, 0.0, 0.3])
    view = likeness(composite(planar[None]), planar, reach=0.3)
    (rows, columns), xy = view.around(planar, reach=0.75)
    assert xy.shape == (rows.stop - rows.start, columns.stop - columns.start, 2)
    seen = project(LENS, VIEW, np.array([[*planar[:2], PRIOR.height + TOP]]))[0]
    row, column = round(seen[1]) - rows.start, round(seen[0]) - columns.start
    np.testing.assert_allclose(xy[row, column], planar[:2], atol=3e-3)
    reach = 0.75 * np.hypot(*SIZE)
    assert np.abs(xy - planar[:2]).max() > reach - 5e-3


def test_an_exposure_is_less_sure_the_less_of_it_is_seen_and_the_less_it_is_alike():
    shares = (1.0, 0.5, 0.25, 0.1, 0.05, 0.0)
    for sd in (
        [disturbance_sd(0.99, each) for each in shares],
        [strip_sd(each) for each in shares],
    ):
        assert sd == sorted(sd)
        assert sd[-2] == sd[-1] < 0.06
    assert disturbance_sd(1.0, 1.0) == strip_sd(1.0) == 0.0
    assert disturbance_sd(0.8, 1.0) > 3 * disturbance_sd(0.98, 1.0)
