# SPDX-License-Identifier: MIT
"""What `--board` says is a board, or is refused."""

import pytest

from tracking.camera import CharucoBoard, Checkerboard
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.camera.board_argument import parse_board


@pytest.mark.parametrize(
    "text", ["9x6", "checkerboard:9:25mm", "charuco:7x5:26mm:35mm:4x4_50", "checkerboard:9x6:25",
             "charuco:7x5:35mm:26mm:4x4_51", "kit:a4"],
)  # fmt: skip
def test_what_is_no_board_is_refused(text):
    with pytest.raises(SettingsError, match="--board"):
        parse_board(text)


def test_boards_are_what_their_description_says():
    assert parse_board("checkerboard:9x6:25mm") == Checkerboard(9, 6, 0.025)
    assert parse_board("charuco:7x5:35mm:25mm:5x5_50") == CharucoBoard(7, 5, 0.035, 0.025, "5x5_50")
    assert isinstance(parse_board("kit"), CharucoBoard)
