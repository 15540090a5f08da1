# SPDX-License-Identifier: MIT
"""A millimetre of the kit is a millimetre on paper, and what is printed is found again."""

import re

import cv2
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from tracking.camera import find_board
from tracking.markers import find_markers
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_print import KIT_PRINT
from zebro_lab.track.camera.kit import (
    BOARD,
    FLOOR_MARKERS,
    FLOOR_SIDE,
    PAPERS,
    kit_pages,
    squares_of,
)
from zebro_lab.track.camera.pictures import draw_page, save_pages
from zebro_lab.track.camera.stage import parse_board

POINT = 25.4 / 72  # mm
ROBOT_PAGE, BOARD_PAGE = 1, -1


@pytest.fixture(scope="module")
def pdf(tmp_path_factory) -> bytes:
    file = tmp_path_factory.mktemp("kit") / "kit.pdf"
    save_pages(kit_pages("a4"), file)
    return file.read_bytes()


def test_the_sheets_have_the_size_of_their_paper(pdf):
    boxes = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", pdf)
    sizes = {(round(float(w) * POINT, 1), round(float(h) * POINT, 1)) for w, h in boxes}
    assert sizes == {(210.0, 297.0), (297.0, 210.0)}


def picture(page, dpi: int) -> np.ndarray:
    figure = draw_page(page)
    figure.set_dpi(dpi)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[:, :, 2::-1])


def test_printed_markers_are_found_upright_with_their_side():
    pages = kit_pages("a4")[ROBOT_PAGE:BOARD_PAGE]
    sides = (1e3 * KIT_PRINT.side, *(FLOOR_SIDE for _ in FLOOR_MARKERS))
    for page, number, side in zip(pages, (0, *FLOOR_MARKERS), sides, strict=True):
        sheet = picture(page, 60)
        (found,) = find_markers(sheet, "4x4_50", wanted=[number], effort=0)
        top_left, top_right, _, bottom_left = found.corners_px
        assert top_left[0] < top_right[0]
        assert top_left[1] < bottom_left[1]
        border = 1 - sheet[round(top_left[1]) + 5, :, 0] / 255
        assert border.sum() / 60 * 25.4 == pytest.approx(side, abs=0.3)


def test_the_printed_board_is_the_one_that_calibrates():
    view = find_board(picture(kit_pages("a4")[BOARD_PAGE], 100), BOARD)
    assert view is not None
    assert len(view.points) == (BOARD.columns - 1) * (BOARD.rows - 1)
    scale = cv2.estimateAffine2D(1e3 * view.points[:, :2], view.corners_px)[0][0, 0]
    assert scale == pytest.approx(100 / 25.4, rel=1e-3)


@pytest.mark.parametrize("paper", PAPERS)
def test_a_checkerboard_is_printed_with_the_corners_that_it_is_named_by(paper):
    board = parse_board("checkerboard:10x7:15mm")
    page = kit_pages(paper, board)[BOARD_PAGE]
    assert squares_of(board) == (11, 8)
    view = find_board(picture(page, 100), board)
    assert view is not None
    assert len(view.points) == 70
    mm = view.corners_px / (100 / 25.4)
    np.testing.assert_allclose(np.linalg.norm(mm[1] - mm[0]), 15.0, atol=0.1)
    assert any("11 x 8 squares, with 10 x 7 corners" in text.text for text in page.texts)


def test_a_board_that_does_not_fit_on_the_paper_is_refused():
    with pytest.raises(SettingsError, match=r"10 x 7 squares are 400 x 280 mm; .* 281 x 179 mm"):
        kit_pages("a4", parse_board("checkerboard:9x6:40mm"))
