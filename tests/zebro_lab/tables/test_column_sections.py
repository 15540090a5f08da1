# SPDX-License-Identifier: MIT
"""Sections of a columns.toml, and values that nobody has checked."""

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.column_sections import read_section


def section(folder, text, kind="rig"):
    (folder / "columns.toml").write_text(text)
    return read_section(kind, folder / "columns.toml")


def test_entries_without_sections_are_for_rig_and_legs(tmp_path):
    text = 'source = "real"\n[columns]\nt = "ET"\n'
    for kind in ("rig", "legs"):
        assert section(tmp_path, text, kind).left == ("source", "columns")
    for kind in ("imu", "track"):
        assert section(tmp_path, text, kind).left == ("source",)


def test_each_kind_has_a_section_and_all_share_the_source(tmp_path):
    text = 'source = "real"\n[legs.columns]\nt = "ET"\n[track]\nsheet = "A"\n'
    assert section(tmp_path, text, "legs").left == ("source", "columns")
    assert section(tmp_path, text, "track").text("sheet") == "A"
    assert section(tmp_path, text, "rig").left == ("source",)


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ('[columns.t]\nunit = "ms?"', 'columns.t.unit = "ms?"'),
        ('[columns.t]\nsign = "-1?"', 'columns.t.sign = "-1?"'),
        ('[columns]\nt = "ET?"', 'columns.t = "ET?"'),
        ('[constants]\nradius_leg = "35 mm?"', 'constants.radius_leg = "35 mm?"'),
        ('[runs]\nby = ["a", "b?"]', 'runs.by = "b?"'),
        ('[rig.columns.t]\nname = "ET?"\nunit = "?"', 'name = "ET?", rig.columns.t.unit = "?"'),
    ],
)
def test_a_guess_that_nobody_checked_is_refused(tmp_path, text, keys):
    with pytest.raises(SettingsError, match="nobody has checked") as raised:
        section(tmp_path, text)
    assert keys in str(raised.value)


def test_guesses_of_another_kind_of_table_do_not_matter(tmp_path):
    text = '[legs.columns.t]\nunit = "ms?"\n[rig.columns]\nt = "ET"\n[rig.rows]\nkeep = ["a? > 1"]'
    assert "columns" in section(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "problem"), [("[legs]\n[leg]\n", "leg: unknown key"), ("legs = 1", "a section")]
)
def test_what_is_no_section_is_refused(tmp_path, text, problem):
    with pytest.raises(SettingsError, match=problem):
        section(tmp_path, text, "legs")
