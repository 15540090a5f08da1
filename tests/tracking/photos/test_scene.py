# SPDX-License-Identifier: MIT
"""Clicks of one photograph hold for all of a tripod's where the floor has no markers."""

from dataclasses import replace

import numpy as np

from tracking.floor import FloorMap, FloorView

CLICKS = {"p0.png": {"door": (10.0, 20.0)}, "p2.png": {"drain": (5.0, 6.0)}}


def keys(scene, photo):
    return set(scene.with_clicks(FloorView.of(photo)).pixels)


def test_without_markers_the_clicks_of_one_photograph_hold_for_the_others(scene):
    bare = replace(scene, floor=FloorMap("4x4_50", ()), clicks=CLICKS)
    assert keys(bare, "p2.png") == {"drain"}
    assert keys(bare, "p1.png") == {"door"}


def test_with_markers_a_click_holds_for_its_own_photograph_alone(scene):
    marked = replace(scene, clicks=CLICKS)
    assert keys(marked, "p0.png") == {"door"}
    assert keys(marked, "p1.png") == set()
    seen = marked.with_clicks(FloorView.of("p0.png"))
    np.testing.assert_array_equal(seen.pixels["door"], [[10.0, 20.0]])
