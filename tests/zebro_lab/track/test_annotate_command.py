# SPDX-License-Identifier: MIT
"""`zebro-lab annotate` as its user meets it."""

import cv2
import pytest

from support.bundled_walk import PHOTOS
from zebro_lab.track.annotations import read_annotations


def test_annotations_are_added_to_those_before(run_command, tmp_path):
    file = tmp_path / "said.toml"
    code, _, _ = run_command(
        "annotate", PHOTOS, "--out", file, "--photo", "simulated_01.jpg", "--corners",
        "1,2 3,2 3,8 1,8", "--plate", "150mmx140mm@40mm", "--flip", "simulated_02.jpg",
    )  # fmt: skip
    assert code == 0
    code, out, _ = run_command(
        "annotate", PHOTOS, "--out", file, "--click", "simulated_03.jpg:door=10,20",
        "--delete", "simulated_06.jpg",
    )  # fmt: skip
    assert code == 0
    assert "robot's top in simulated_01.jpg, 1 points of the floor, 2 corrections" in out
    said = read_annotations(file)
    assert said.templates[0].plate.width == 0.14
    assert len(said.corrections) == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--photo", "simulated_01.jpg", "--corners", "1,2 3,4"), "2 corners; expected four"),
    ],
)
def test_what_cannot_be_understood_is_one_line(options, message, run_command, tmp_path):
    file = tmp_path / "said.toml"
    code, _, err = run_command("annotate", PHOTOS, "--out", file, *options)
    assert code == 2
    assert message in err
    assert err.count("\n") == 1
    assert not file.exists()


def test_pixels_can_be_read_in_a_picture(run_command, tmp_path):
    file = tmp_path / "grid.png"
    code, _, _ = run_command(
        "annotate", PHOTOS, "--photo", "simulated_01.jpg", "--grid", file, "--around", "300,800"
    )
    assert code == 0
    assert cv2.imread(str(file)) is not None
