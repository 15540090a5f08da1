# SPDX-License-Identifier: MIT


import numpy as np
import pytest

from model.walk.ground import height_and_slopes, is_level
from zebro_lab.files.errors import DataError, SettingsError, ZebroLabError
from zebro_lab.ground.ground_file import read_ground

MAP = 'heights = "h.csv"\nstep = 0.1\norigin = [1, 2]\n'
HEIGHTS = np.array([[0.0, 0.001, 0.002], [0.01, 0.011, -0.012]])


@pytest.fixture
def read(tmp_path):
    """Return a function that writes a ground.toml beside maps of heights, and reads it."""
    (tmp_path / "h.csv").write_text("0.00,0.01,0.02\n0.03,0.04,0.05\n")
    (tmp_path / "mm.csv").write_text("0,5\n-10,2\n")

    def reader(text):
        file = tmp_path / "ground.toml"
        file.write_text(text)
        return read_ground(file)

    return reader


def height(ground, x, y):
    return height_and_slopes(ground.ground, x, y)[0]


def test_a_slope_rises_along_x_and_y(read):
    ground = read("slope_deg = [5, -2.0]")
    expected = np.tan(np.radians(5)) * 0.3 - np.tan(np.radians(2)) * 7.0
    assert height(ground, 0.3, 7.0) == pytest.approx(expected)
    assert ground.what == ("slope of 5 deg along x, -2 deg along y",)


def test_a_map_lies_with_its_first_row_farthest_and_its_first_column_at_the_origins_x(read):
    ground = read(MAP)
    assert [height(ground, x, y) for x, y in ((1.0, 2.0), (1.2, 2.0), (1.0, 2.1))] == (
        pytest.approx([0.03, 0.05, 0.0], abs=1e-6)
    )
    assert len(ground.files) == 2


def test_a_table_in_millimetres_is_a_map_too(read):
    stated = read('heights = "mm.csv"\nunit = "mm"\nstep = 0.1\norigin = [0, 0]')
    assert height(stated, 0.0, 0.0) == pytest.approx(-0.01)


def test_names_of_files_are_relative_to_the_ground(read, tmp_path, monkeypatch):
    monkeypatch.chdir("/")
    assert read(MAP).files[1] == tmp_path / "h.csv"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "describes nothing; expected slope_deg, heights or both"),
        ("slop_deg = [1, 2]", "slop_deg: unknown key; .*slope_deg"),
        ("slope_deg = 5", "slope_deg: found 5; expected a list of 2 numbers"),
        ("slope_deg = [0, 60]", "slope_deg: the slope along y is 60 degrees; expected -45 to 45"),
        ("step = 0.01", "step: found without heights"),
        ("[[step]]\nx = 1\nheight = 10", "step: is no part of a ground; .* map of heights"),
        ("roughness = { sd = 0.005 }", "roughness: is no part of a ground"),
        ("[[area]]\nslip = 'thesis'", "area: is no part of a ground"),
        ("origin = [0, 0]", "origin: found without heights"),
        ('heights = "h.csv"\nstep = 0.1', r"heights\.origin: is missing"),
        ('heights = "h.csv"\norigin = [0, 0]', r"heights\.step: is missing"),
        ('heights = "no.csv"\nstep = 0.1\norigin = [0, 0]', r"no\.csv: no such file"),
        (
            'heights = "mm.csv"\nstep = 0.1\norigin = [0, 0]',
            r'mm\.csv, row 2: cell 1 is -10, .*add unit = "mm"',
        ),
    ],
)  # fmt: skip
def test_mistakes_are_refused_with_their_key(read, text, message):
    with pytest.raises(ZebroLabError, match=message) as refused:
        read(text)
    assert isinstance(refused.value, SettingsError | DataError | FileNotFoundError)
    assert "\n" not in str(refused.value)


def map_of(tmp_path, text):
    """Write a map of heights, and read it by a ground.toml; return rows and columns."""
    (tmp_path / "h.csv").write_text(text)
    file = tmp_path / "ground.toml"
    file.write_text('heights = { file = "h.csv", step = 0.1, origin = [0, 0], unit = "m" }')
    return read_ground(file).ground.height.T[::-1]


@pytest.mark.parametrize(
    "text",
    [
        "0,0.001,0.002\n0.01,0.011,-0.012\n",
        "# metres\n\n0; 0.001; 0.002\n0.01;0.011;-0.012",
        "0;0,001;0,002\n0,01;0,011;-0,012\n",
        "0\t0,001\t0,002\n0,01\t0,011\t-0,012\n",
        "  0 0.001  0.002\n 0.01 1.1e-2 -0.012\n",
        "0,0.001,0.002,\n0.01,0.011,-0.012,\n",
    ],
)
def test_tables_are_read_whatever_separates_their_cells(tmp_path, text):
    np.testing.assert_array_equal(map_of(tmp_path, text), HEIGHTS)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0,0,0\n0,0\n", r"row 2 \(line 2\): has 2 heights, the rows above have 3"),
        ("0,0\n0,nan\n", r"row 2 \(line 2\): cell 2 is 'nan'; expected a height as a finite"),
        ("0,0\n0,\n0,0\n", r"row 2 \(line 2\): has 1 heights, the rows above have 2"),
        ("0,,0\n", r"row 1 \(line 1\): cell 2 is empty"),
        ("x,y,z\n0,0,0\n", "row 1 .*cell 1 is 'x'; .*no rows of names"),
        ("0,001 0,002\n0,0 0,0\n", "cell 2 is '001 0'; .*separated by commas"),
        ("0.1\n0.2\n", "has 2 rows and 1 columns of heights"),
        ("", "has 0 rows and 0 columns"),
    ],
)
def test_mistakes_in_tables_are_named_with_row_and_value(tmp_path, text, message):
    with pytest.raises(DataError, match=message):
        map_of(tmp_path, text)


def test_walk_takes_a_written_ground_as_it_is(run_command, tmp_path):
    file = tmp_path / "ground.toml"
    ended = run_command("init", file, "--kind", "ground")
    assert ended.code == 0, ended.err
    assert f"walk --ground {file}" in " ".join(ended.out.split())
    assert is_level(read_ground(file).ground)
    words = ("walk", "--slip", "coulomb:0.4", "--duration", 0.5, "--ground", file)
    assert run_command(*words, "--out", tmp_path / "w").code == 0


def test_an_existing_file_is_kept_unless_it_is_forced(run_command, tmp_path):
    file = tmp_path / "ground.toml"
    file.write_text("slope_deg = [1.0, 0.0]\n")
    ended = run_command("init", file, "--kind", "ground")
    assert ended.code == 1
    assert "exists already; edit it, replace it with --force" in " ".join(ended.err.split())
    assert file.read_text() == "slope_deg = [1.0, 0.0]\n"
    assert run_command("init", file, "--kind", "ground", "--force").code == 0
    assert "heights" in file.read_text()
