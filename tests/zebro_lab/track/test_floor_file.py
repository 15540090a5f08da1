# SPDX-License-Identifier: MIT
"""floor.toml comes back as it was written, and says what is wrong with it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.floor import FloorMap, FloorMarker, FloorPoint
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.floor_file import read_floor_file, render_floor_file

METRES = st.floats(-5, 5).map(lambda x: round(x, 6))
MARKER = st.builds(
    FloorMarker, st.integers(0, 49), st.just(0.15), METRES, METRES,
    yaw=st.floats(-3, 3).map(lambda x: round(x, 6)),
)  # fmt: skip
POINT = st.builds(FloorPoint, st.sampled_from(["door", 'a "b"', "pipe 3"]), METRES, METRES)


@given(
    st.lists(MARKER, min_size=1, max_size=5, unique_by=lambda m: m.marker_id),
    st.lists(POINT, max_size=3, unique_by=lambda p: p.name),
)
def test_a_floor_comes_back(tmp_path_factory, markers, points):
    file = tmp_path_factory.getbasetemp() / "floor.toml"
    floor = FloorMap("5x5_50", tuple(markers), tuple(points))
    file.write_text(render_floor_file(floor, heading="A floor."), encoding="utf-8")
    back = read_floor_file(file)
    assert back.dictionary == "5x5_50"
    assert list(back.marks) == list(floor.marks)
    for key, mark in floor.marks.items():
        np.testing.assert_allclose(back.marks[key].points, mark.points, atol=1e-6)
        np.testing.assert_allclose(back.marks[key].prior_sd, mark.prior_sd, rtol=1e-4)


def test_what_all_markers_share_is_said_once_and_one_may_differ(tmp_path):
    file = tmp_path / "floor.toml"
    file.write_text(
        'side = "150 mm"\nposition_sd = "2 mm"\n[markers]\n10 = { x = 0, y = "-50 cm" }\n'
        "11 = { x = 2, y = 0, side = 0.1, yaw_deg = 90 }\n"
    )
    ten, eleven = read_floor_file(file).markers
    assert (ten.side, ten.y, ten.position_sd) == (0.15, -0.5, 0.002)
    assert eleven.side == 0.1
    assert eleven.yaw == pytest.approx(np.pi / 2)


FAULTS = {
    "no marks": ('dictionary = "4x4_50"', "no marker and no point"),
    "no side": ("[markers]\n10 = { x = 0, y = 0 }", r"markers\.10\.side: is missing"),
    "no place": ("side = 0.1\n[markers]\n10 = { x = 0 }", r"markers\.10\.y: is missing"),
    "negative side": ("side = -1\n[markers]\n10 = { x = 0, y = 0 }", "expected more than 0"),
    "no number": ("side = 0.1\n[markers]\nten = { x = 0, y = 0 }", "not a marker's number"),
    "unknown key": ("side = 0.1\n[markers]\n10 = { x = 0, y = 0, yaw = 9 }", "yaw_deg"),
    "no dictionary": ('dictionary = "4x4_51"\nside = 1\n[points]\na = { x = 0, y = 0 }', "4x4_50"),
    "no length": ('side = "1 kg"\n[markers]\n10 = { x = 0, y = 0 }', "kg"),
}


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_a_fault_is_named_with_file_and_key(tmp_path, text, message):
    file = tmp_path / "floor.toml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=message) as caught:
        read_floor_file(file)
    assert str(file) in str(caught.value)


def test_the_file_of_the_other_option_is_distinguished(tmp_path):
    file = tmp_path / "x.toml"
    file.write_text("focal = [1, 1]\n")
    with pytest.raises(SettingsError, match=r"are --camera and --floor exchanged\?"):
        read_floor_file(file)
