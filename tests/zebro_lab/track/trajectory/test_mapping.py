# SPDX-License-Identifier: MIT
"""The column map of a trajectory is the section [track], or a whole file that is named."""

import pytest

from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.track.trajectory.mapping import trajectory_columns

MAP = '[columns]\nx_m = {name = "east", unit = "mm"}\n'
SECTION = MAP.replace("[columns]", "[track.columns]")


@pytest.fixture
def beside(tmp_path):
    """Return a function that writes a columns.toml, and reads that of a trajectory beside it."""

    def read(text, named=None):
        (tmp_path / "columns.toml").write_text(text)
        return trajectory_columns(tmp_path / "a.csv", named)

    return read


def test_a_section_beside_the_file_or_a_whole_named_file_is_read(beside, tmp_path):
    assert trajectory_columns(tmp_path / "a.csv", None) is None
    assert beside(MAP) is None  # of a rig or of legs
    for text, named in ((SECTION, None), (MAP, tmp_path / "columns.toml")):
        found = beside(f'source = "real"\n{text}', named)
        assert (found.mapped["x_m"].name, found.mapped["x_m"].factor) == ("east", 1e-3)
        assert found.source == "real"
    with pytest.raises(NotFound):
        trajectory_columns(tmp_path / "a.csv", tmp_path / "other.toml")


@pytest.mark.parametrize("rest", ["[legs]\n", MAP])
def test_the_source_of_a_file_that_maps_other_tables_is_kept(beside, rest):
    found = beside(f'source = "sim:x"\n{rest}')
    assert (found.source, found.mapped["x_m"].name) == ("sim:x", "x_m")


def test_guesses_that_nobody_has_checked_are_named(beside, tmp_path):
    guessed = 'x_m = {name = "east?", unit = "mm?"}\n'
    message = r"2 values are guesses .*x_m\.name = \"east\?\", .*x_m\.unit = \"mm\?\""
    with pytest.raises(SettingsError, match=message):
        beside(f"[track.columns]\n{guessed}")
    with pytest.raises(SettingsError, match=message):
        beside(f"[columns]\n{guessed}", tmp_path / "columns.toml")
    assert beside(f"{SECTION}[legs.columns]\nt = 'time?'\n") is not None


def test_a_section_that_is_no_table_is_refused(beside):
    with pytest.raises(SettingsError, match="expected a section"):
        beside("track = 3\n")
