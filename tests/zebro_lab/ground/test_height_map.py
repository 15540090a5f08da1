# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from PIL import Image

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.ground.height_map import read_height_picture, read_height_table

HEIGHTS = np.array([[0.0, 0.001, 0.002], [0.01, 0.011, -0.012]])


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
    file = tmp_path / "h.csv"
    file.write_text(text)
    np.testing.assert_array_equal(read_height_table(file), HEIGHTS)


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
    file = tmp_path / "h.csv"
    file.write_text(text)
    with pytest.raises(DataError, match=message):
        read_height_table(file)


def test_a_picture_of_16_bits_spans_its_range(tmp_path):
    file = tmp_path / "h.png"
    Image.fromarray(np.array([[0, 65535], [13107, 0]], dtype=np.uint16)).save(file)
    found = read_height_picture(file, -0.01, 0.04)
    np.testing.assert_allclose(found, [[-0.01, 0.04], [0.0, -0.01]], atol=1e-12)


def test_pictures_that_are_no_maps_are_refused(tmp_path):
    grey, text, none = tmp_path / "g.png", tmp_path / "t.png", tmp_path / "none.png"
    Image.fromarray(np.zeros((4, 4), dtype=np.uint8)).save(grey)
    text.write_text("0,0\n")
    with pytest.raises(DataError, match="of mode L; expected grey values of 16 bits"):
        read_height_picture(grey, 0.0, 1.0)
    with pytest.raises(DataError, match="cannot be read as a picture"):
        read_height_picture(text, 0.0, 1.0)
    with pytest.raises(NotFound, match=r"ground\.toml names it"):
        read_height_picture(none, 0.0, 1.0)
