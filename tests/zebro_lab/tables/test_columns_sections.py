# SPDX-License-Identifier: MIT
"""A kind of table has its section of a `columns.toml`, of the nearest that has one."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.columns_sections import (
    columns_above,
    nearest_columns,
    read_nearest,
    read_section,
)


def section(folder, text, kind="rig"):
    (folder / "columns.toml").write_text(text)
    return read_section(kind, folder / "columns.toml")


def test_entries_without_sections_are_for_rig_and_legs(tmp_path):
    text = 'source = "real"\n[columns]\nt = "ET"\n'
    for kind in ("rig", "legs"):
        assert section(tmp_path, text, kind).unread == ("source", "columns")
    for kind in ("imu", "track"):
        assert section(tmp_path, text, kind).unread == ("source",)


def test_each_kind_has_a_section_and_all_share_the_source(tmp_path):
    text = 'source = "real"\n[legs.columns]\nt = "ET"\n[track]\nsheet = "A"\n'
    assert section(tmp_path, text, "legs").unread == ("source", "columns")
    assert section(tmp_path, text, "track").text("sheet") == "A"
    assert section(tmp_path, text, "rig").unread == ("source",)


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


def test_the_nearest_columns_with_something_for_the_kind_are_taken(tmp_path, monkeypatch):
    deep = tmp_path / "a" / "b"
    deep.mkdir(parents=True)
    assert nearest_columns("track", deep)[0] is None
    (tmp_path / "columns.toml").write_text("[track.columns.y_m]\nsign = -1\n")
    (tmp_path / "a" / "columns.toml").write_text('source = "real"\n')
    assert nearest_columns("track", deep)[0] == tmp_path / "columns.toml"
    assert nearest_columns("imu", deep)[0] == tmp_path / "a" / "columns.toml"  # for its source
    assert nearest_columns("rig", deep)[0] == tmp_path / "a" / "columns.toml"
    (deep / "columns.toml").write_text("[track]\n")
    assert nearest_columns("track", deep)[0] == deep / "columns.toml"
    monkeypatch.chdir(tmp_path)
    assert nearest_columns("rig", Path("a/b"))[0] == Path("a/columns.toml")


def test_a_map_of_a_rig_above_is_none_of_legs_and_the_other_way_round(tmp_path):
    below = tmp_path / "walks"
    below.mkdir()
    (tmp_path / "columns.toml").write_text('[columns]\nnormal_force = "FZ"\n')
    assert nearest_columns("legs", below)[0] is None
    assert nearest_columns("rig", below)[0] == tmp_path / "columns.toml"
    (tmp_path / "columns.toml").write_text('[columns]\ntheta1 = "fl"\n')
    assert nearest_columns("rig", below)[0] is None
    assert nearest_columns("legs", below)[0] == tmp_path / "columns.toml"
    assert nearest_columns("rig", tmp_path)[0] == tmp_path / "columns.toml"


@pytest.mark.parametrize(
    ("above", "beside", "source"),
    [
        ("[track]\n", 'source = "sim:robot"\n[legs]\n', "sim:robot"),
        ('source = "real"\n[track]\n', 'source = "sim:robot"\n[legs]\n', "sim:robot"),
        ("[track]\n", 'source = "sim:robot"\n[columns]\nt = "ET"\n', "sim:robot"),
        ('source = "sim:robot"\n[legs]\n', "[track]\n", "sim:robot"),
        ('source = "real"\n[track]\n', '[track]\nsource = "sim:robot"\n', "sim:robot"),
    ],
)
def test_the_source_is_the_nearest_whichever_file_maps_the_columns(tmp_path, above, beside, source):
    below = tmp_path / "run"
    below.mkdir()
    (tmp_path / "columns.toml").write_text(above)
    (below / "columns.toml").write_text(beside)
    found = read_nearest("track", below)
    assert found is not None
    assert found.text("source") == source


def test_a_nearer_source_that_is_none_names_its_own_file(tmp_path):
    below = tmp_path / "run"
    below.mkdir()
    (tmp_path / "columns.toml").write_text("[rig]\n")
    (below / "columns.toml").write_text('source = "simulated"\n[legs]\n')
    with pytest.raises(SettingsError, match="found 'simulated'; expected real") as raised:
        read_nearest("rig", below)
    assert raised.value.file == below / "columns.toml"


def test_what_is_stated_above_the_named_folder_is_noted(tmp_path):
    below = tmp_path / "run"
    below.mkdir()
    table, file = below / "a.csv", tmp_path / "columns.toml"
    assert columns_above("track", table, None) == ()
    file.write_text('source = "real"\n[track.columns.y_m]\nsign = -1\n')
    mapped, source = columns_above("track", table, None)
    assert mapped == f"a.csv: columns are those of {file}, the nearest for track above it"
    assert source == f"a.csv: its source, real, is stated in {file}, above it"
    assert columns_above("legs", table, None) == (source,)
    assert columns_above("track", table, file) == ()
    assert columns_above("track", table, None, root=tmp_path) == ()
    (below / "columns.toml").write_text("[track]\n")
    assert columns_above("track", table, None) == (source,)


def test_a_result_of_a_command_takes_no_columns_from_above(tmp_path):
    result = tmp_path / "walk"
    result.mkdir()
    (tmp_path / "columns.toml").write_text('[legs.columns]\ntheta1 = "fl"\n')
    assert nearest_columns("legs", result)[0] == tmp_path / "columns.toml"
    (result / "manifest.json").write_text('{"kind": "walk", "schema": 1, "outputs": {}}')
    assert nearest_columns("legs", result)[0] is None
