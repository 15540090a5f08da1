# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from PIL import Image

from model.walk.ground import height_and_slopes
from model.walk.traction import VelocityCoulomb
from zebro_lab.files.errors import DataError, SettingsError, ZebroLabError
from zebro_lab.ground.ground_file import read_ground

STEP = "[[step]]\nx = 0.5\nheight = 0.01\n"
ROUGH = 'roughness = { sd = "5 mm", correlation = 0.05, seed = 7 }\n'
AREA = '[[area]]\npolygon = [[0, 0], ["50 cm", 0], [0, 1]]\nslip = "coulomb:0.1"\n'
MAP = 'heights = "h.csv"\nstep = 0.1\norigin = [1, 2]\n'


@pytest.fixture
def read(tmp_path):
    """Return a function that writes a ground.toml beside a map of heights, and reads it."""
    (tmp_path / "h.csv").write_text("0.00,0.01,0.02\n0.03,0.04,0.05\n")
    (tmp_path / "mm.csv").write_text("0,5\n-10,2\n")
    (tmp_path / "ice.toml").write_text("nothing = 1\n")
    Image.fromarray(np.full((2, 3), 65535, dtype=np.uint16)).save(tmp_path / "h.png")

    def reader(text):
        file = tmp_path / "ground.toml"
        file.write_text(text)
        return read_ground(file)

    return reader


def height(ground, x, y):
    return height_and_slopes(ground.terrain.ground, x, y)[0]


def test_a_slope_rises_along_x_and_y(read):
    ground = read("slope_deg = [5, -2.0]")
    expected = np.tan(np.radians(5)) * 0.3 - np.tan(np.radians(2)) * 7.0
    assert height(ground, 0.3, 7.0) == pytest.approx(expected)
    assert ground.what == ("slope of 5 deg along x, -2 deg along y",)


def test_the_ground_is_higher_beyond_a_step_up_and_lower_beyond_one_down(read):
    ground = read(STEP + STEP.replace("0.5", "0.8").replace("0.01", "-0.03"))
    assert [height(ground, x, 0.0) for x in (0.45, 0.6, 0.9)] == pytest.approx([0, 0.01, -0.02])


def test_parts_add_up(read):
    whole = 'heights = { file = "h.csv", step = 0.1, origin = [1, 2] }\nslope_deg = [1, 2]\n' + STEP
    alone = ('heights = { file = "h.csv", step = 0.1, origin = [1, 2] }', "slope_deg = [1, 2]",
             STEP)  # fmt: skip
    summed = sum(height(read(each), 1.12, 2.05) for each in alone)
    assert height(read(whole), 1.12, 2.05) == pytest.approx(summed)


def test_a_map_lies_with_its_first_row_farthest_and_its_first_column_at_the_origins_x(read):
    ground = read(MAP)
    assert [height(ground, x, y) for x, y in ((1.0, 2.0), (1.2, 2.0), (1.0, 2.1))] == (
        pytest.approx([0.03, 0.05, 0.0], abs=1e-6)
    )
    assert len(ground.files) == 2


def test_a_picture_and_a_table_in_millimetres_are_maps_too(read):
    white = read('heights = "h.png"\nstep = 0.1\norigin = [1, 2]\nrange = [0, 0.02]')
    assert height(white, 1.1, 2.05) == pytest.approx(0.02)
    stated = read('heights = "mm.csv"\nunit = "mm"\nstep = 0.1\norigin = [0, 0]')
    assert height(stated, 0.0, 0.0) == pytest.approx(-0.01)


def test_roughness_is_that_of_its_seed_and_is_added_to_a_map(read):
    one, again = read(ROUGH), read(ROUGH)
    assert height(one, 0.3, 0.4) == height(again, 0.3, 0.4) != 0
    other = read(ROUGH.replace("7", "8"))
    assert height(other, 0.3, 0.4) != height(one, 0.3, 0.4)
    both = read(MAP.replace("0.1", "0.02") + ROUGH)
    assert height(both, 1.02, 2.02) == pytest.approx(0.01 + height(one, 1.02, 2.02), abs=1e-6)
    assert not both.terrain.ground.repeats


def test_areas_have_their_slip_laws_and_take_units(read):
    ground = read(AREA + AREA.replace("coulomb:0.1", "thesis"))
    first, second = ground.terrain.areas
    np.testing.assert_array_equal(first.polygon, [[0, 0], [0.5, 0], [0, 1]])
    assert first.slip.law == VelocityCoulomb(0.1)
    assert second.slip.source == "thesis"
    assert ground.settings["area"][0]["slip"] == "coulomb:0.1"


def test_names_of_files_are_relative_to_the_ground(read, tmp_path, monkeypatch):
    monkeypatch.chdir("/")
    assert read(MAP).files[1] == tmp_path / "h.csv"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "describes nothing; expected one or more of slope_deg"),
        ("slop_deg = [1, 2]", "slop_deg: unknown key; .*slope_deg"),
        ("slope_deg = 5", "slope_deg: found 5; expected a list of 2 numbers"),
        ("slope_deg = [0, 60]", "slope_deg: the slope along y is 60 degrees; expected -45 to 45"),
        ("step = 0.01", r"step: expected tables \[\[step\]\] with x and height, or heights"),
        ("[[step]]\nx = 1\nheight = 10", r"step\[1\]\.height: is 10 m, which is improbable"),
        ("[[step]]\nx = 1\nheight = 0", r"step\[1\]\.height: is 0; expected a height above 0"),
        ("[[step]]\nx = 1\nhight = 0.01", r"step\[1\]\.height: is missing; found 'hight'"),
        ("roughness = { sd = 0.005 }", r"roughness\.correlation: is missing"),
        ("roughness = { sd = 0.1, correlation = 0.05 }", "roughness: .*slopes of 2"),
        ("roughness = { sd = 5, correlation = 0.05 }", r"roughness\.sd: is 5 m, .*improbable"),
        ("origin = [0, 0]", "origin: found without heights"),
        ('heights = "h.csv"\nstep = 0.1', r"heights\.origin: is missing"),
        ('heights = "h.csv"\norigin = [0, 0]', r"heights\.step: is missing"),
        (MAP + "range = [0, 1]", r"heights\.range: is for pictures"),
        ('heights = "h.csv"\norigin = [0, 0]\n' + STEP, "step: are tables here, .*heights = {"),
        ('heights = "h.png"\nstep = 0.1\norigin = [0, 0]', r"heights\.range: is missing"),
        (
            'heights = "h.png"\nstep = 0.1\norigin = [0, 0]\nrange = [1, 0]',
            r"heights\.range: is \[1, 0\]; expected the height of a black pixel",
        ),
        ('heights = "no.csv"\nstep = 0.1\norigin = [0, 0]', r"no\.csv: no such file"),
        (
            'heights = "mm.csv"\nstep = 0.1\norigin = [0, 0]',
            r'mm\.csv, row 2: cell 1 is -10, .*add unit = "mm"',
        ),
        (MAP + "roughness = { sd = 0.005, correlation = 0.05 }", "shorter than two steps"),
        ("[[area]]\npolygon = [[0, 0], [1, 0]]\nslip = 'thesis'", r"area\[1\]\.polygon: found 2"),
        ("[[area]]\npolygon = [0, 1]\nslip = 'thesis'", r"found \[0, 1\]; expected a list"),
        (AREA.replace('"50 cm"', "2000"), r"area\[1\]\.corner\[2\]\.x: is 2000 m, .*improbable"),
        (AREA.replace("0.1", "x"), r"area\[1\]\.slip: .*coulomb"),
        (AREA.replace("coulomb:0.1", "nowhere"), r"area\[1\]\.slip: .*nowhere' is not a file"),
        (AREA.replace("slip", "slpi"), r"area\[1\]\.slip: is missing; found 'slpi'"),
    ],
)  # fmt: skip
def test_mistakes_are_refused_with_their_key(read, text, message):
    with pytest.raises(ZebroLabError, match=message) as refused:
        read(text)
    assert isinstance(refused.value, SettingsError | DataError | FileNotFoundError)
    assert "\n" not in str(refused.value)
