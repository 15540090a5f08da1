# SPDX-License-Identifier: MIT
"""Marks of a floor are laid down once."""

import pytest

from support.drawn_floor import FLOOR
from tracking.errors import FloorError
from tracking.floor import (
    FloorMap,
)


def test_a_mark_laid_down_twice_is_refused():
    with pytest.raises(FloorError, match="marker 10 twice"):
        FloorMap("4x4_50", (FLOOR.markers[0], FLOOR.markers[0]))
