# SPDX-License-Identifier: MIT
"""A picture's name says its format."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.picture_format import FORMATS, format_of, in_every_format


@pytest.mark.parametrize("form", FORMATS)
def test_names_in_every_format_are_of_that_format(form):
    names = in_every_format("map", "path")
    assert {f"map.{form}", f"path.{form}"} <= set(names)
    assert len(names) == 2 * len(FORMATS)
    assert format_of(Path(f"a.b/map.{form.upper()}")) == form


@pytest.mark.parametrize("name", ["map", "map.jpg", "map.png.gz", "png"])
def test_other_suffixes_are_refused_with_those_there_are(name):
    with pytest.raises(SettingsError, match=rf"{name}.*\.png, \.svg, \.pdf"):
        format_of(Path(name))
