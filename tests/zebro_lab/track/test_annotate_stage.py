# SPDX-License-Identifier: MIT
"""What is said of photographs is understood, added to what was said before, and written."""

from dataclasses import replace
from math import pi
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracking.corrections import Delete, Flip, Move
from zebro_lab.files.errors import AlreadyExists, NotFound, SettingsError
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.track.annotate_request import AnnotateRequest
from zebro_lab.track.annotate_stage import annotate, draw_grid, photo_names
from zebro_lab.track.annotations import read_annotations


@pytest.fixture
def photos(tmp_path) -> Path:
    """Return a folder of two photographs."""
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in ("p1.png", "p2.png"):
        cv2.imwrite(str(folder / name), np.full((60, 80, 3), 120, np.uint8))
    return folder


@pytest.fixture
def asked(photos, tmp_path) -> AnnotateRequest:
    """Return a request that says nothing yet."""
    return AnnotateRequest(photos, tmp_path / "said.toml")


def test_corrections_come_as_moves_flips_and_deletions(asked):
    said = annotate(replace(
        asked, moves=("p1.png:0.5,-0.1,90",), flips=("p2.png",), deletes=("p1.png",),
    ))  # fmt: skip
    assert said.corrections == (
        Move("p1.png", 0.5, -0.1, pi / 2), Flip("p2.png"), Delete("p1.png"),
    )  # fmt: skip
    again = read_annotations(asked.out)
    assert again.corrections[1:] == said.corrections[1:]
    moved = again.corrections[0]
    assert isinstance(moved, Move)
    assert (moved.photo, moved.yaw) == ("p1.png", pytest.approx(pi / 2))


def test_the_top_and_points_of_the_floor_are_clicked_on(asked):
    corners = "1,2 3,2 3,8 1,8"
    said = annotate(replace(
        asked, photo="p1.png", corners=corners, plate="194mmx251mm@35mm", margin="10mm",
        clicks=("p2.png:door=10,20.5",),
    ))  # fmt: skip
    assert said.templates[0].corners_px == ((1, 2), (3, 2), (3, 8), (1, 8))
    plate = said.templates[0].plate
    assert (plate.length, plate.width, plate.height, plate.margin) == (0.194, 0.251, 0.035, 0.01)
    assert said.clicks == {"p2.png": {"door": (10.0, 20.5)}}


def test_a_plate_in_millimetres_needs_their_unit(asked):
    corners = "1,2 3,2 3,8 1,8"
    with pytest.raises(SettingsError, match=r"--plate: is 194 m, .* as .194 mm"):
        annotate(replace(asked, photo="p1.png", corners=corners, plate="194x251@35"))


def test_without_a_plate_the_top_is_the_body_of_the_robot(asked):
    said = annotate(replace(asked, photo="p1.png", corners="1,2 3,2 3,8 1,8"))
    plate, (length, width, height) = said.templates[0].plate, RobotFile().robot.body_size
    assert (plate.length, plate.width, plate.height) == (length, width, height / 2)


def test_what_another_file_says_is_added_but_never_to_itself(asked, tmp_path):
    other = tmp_path / "other.toml"
    annotate(replace(asked, out=other, flips=("p1.png",)))
    said = annotate(replace(asked, added=other, deletes=("p2.png",)))
    assert set(said.corrections) == {Flip("p1.png"), Delete("p2.png")}
    with pytest.raises(AlreadyExists, match="choose another"):
        annotate(replace(asked, added=asked.out))


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"flips": ("p1.pgn",)}, "did you mean 'p1.png'"),
        ({"flips": ("p3.png",)}, "no photograph 'p3.png'; there are p1.png to p2.png"),
        ({"photo": "p1.png", "corners": "1,2"}, "1 corners"),
        ({"corners": "1,2 3,2 3,8 1,8"}, "name the photograph"),
        (
            {"photo": "p1.png", "corners": "1,2 3,2 3,8 1,8", "plate": "2mm"},
            "is not LENGTHxWIDTH@HEIGHT",
        ),
        ({"moves": ("p1.png:1,2",)}, "is not PHOTO:X,Y,YAW"),
        ({"clicks": ("1,2",)}, "is not PHOTO:NAME"),
        ({"clicks": ("p1.png:door=a,b",)}, "not a list of numbers"),
    ],
)
def test_what_cannot_be_understood_is_said(asked, said, message):
    with pytest.raises(SettingsError, match=message):
        annotate(replace(asked, **said))
    assert not asked.out.exists()


def test_a_picture_has_one_name_and_its_exposures_are_known(photos, tmp_path):
    picture = photos / "p1.png"
    assert photo_names(picture) == ("p1.png",)
    asked = AnnotateRequest(picture, tmp_path / "said.toml", flips=("p1.png#3",))
    assert annotate(asked).corrections == (Flip("p1.png#3"),)
    with pytest.raises(NotFound):
        photo_names(photos / "p9.png")


def test_a_grid_is_drawn_whole_or_around_a_pixel_and_never_among_the_photographs(photos, tmp_path):
    whole, part = tmp_path / "grid.png", tmp_path / "part.png"
    draw_grid(photos, "p1.png", whole)
    draw_grid(photos / "p1.png", "p1.png", part, around="40,30", reach=10)
    assert cv2.imread(str(whole)) is not None
    assert part.read_bytes() != whole.read_bytes()
    with pytest.raises(AlreadyExists, match="among the photographs"):
        draw_grid(photos, "p1.png", photos / "grid.png")
    with pytest.raises(SettingsError, match="is not a pixel U,V"):
        draw_grid(photos, "p1.png", whole, around="40")
