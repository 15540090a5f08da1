# SPDX-License-Identifier: MIT
"""Leg logs: however they are written the angles are the same, and no fault passes."""

import numpy as np
import pandas as pd
import pytest

from support.leg_tables import leg_table
from support.written_bags import joints, write_bag
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.runs.legs import LegNames, read_leg_log
from zebro_lab.walk.folder import write_path


@pytest.fixture
def read(tmp_path):
    """Return a reader of a table, with the text of a columns.toml if given."""

    def reader(table: pd.DataFrame, mapping: str | None = None, **options):
        table.to_csv(tmp_path / "legs.csv", index=False)
        if mapping is not None:
            (tmp_path / "columns.toml").write_text(mapping)
        return read_leg_log(tmp_path / "legs.csv", **options)

    return reader


def test_canonical_log_is_taken_as_it_is(read):
    table = leg_table()
    found = read(table)
    np.testing.assert_allclose(found.reference.t, table.t)
    np.testing.assert_allclose(found.reference.theta, table[list(ANGLES)])
    assert found.source == "unknown"
    assert "about 100 Hz" in found.notes[0]


def test_other_names_units_and_signs_are_mapped(read):
    table = leg_table()
    theirs = pd.DataFrame({
        "time_ms": table.t * 1000,
        **{f"leg {i}": -np.degrees(table[f"theta{i}"]) for i in range(1, 6)},
        "leg 6": (table.theta6 / (2 * np.pi) * 100) % 100,  # counts, 100 a turn
    })  # fmt: skip
    columns = 'source = "real"\n[columns]\nt = {name = "time_ms", unit = "ms"}\n'
    for i in range(1, 6):
        columns += f'theta{i} = {{name = "leg {i}", unit = "deg", sign = -1}}\n'
    columns += 'theta6 = {name = "leg 6", unit = "centiturn"}\n'
    found = read(theirs, columns)
    np.testing.assert_allclose(found.reference.t, table.t, atol=1e-12)
    np.testing.assert_allclose(found.reference.theta, table[list(ANGLES)], atol=1e-9)
    assert found.source == "real"
    assert [file.name for file in found.files] == ["legs.csv", "columns.toml"]


def test_walked_path_is_a_leg_log(walked, tmp_path):
    write_path(tmp_path / "path.csv", walked)
    np.testing.assert_allclose(read_leg_log(tmp_path).reference.theta, walked.theta)


SETTINGS = {
    "no TOML": ("[columns", "cannot be read as TOML"),
    "unknown table": ("[leg]\n", "leg: unknown key"),
    "a guess": ('[columns.t]\nunit = "ms?"', 'columns.t.unit = "ms?"; correct each'),
    "unknown column": ('[columns]\ntheta7 = "x"', "columns.theta7: unknown key; known: 't'"),
    "unknown key": ('[columns.t]\nnam = "x"', "columns.t.nam: unknown key; did you mean 'name'"),
    "frequency": ('[columns.theta1]\nunit = "Hz"', "columns.theta1.unit: unit 'Hz' cannot be conv"),
    "sign": ("[columns.theta1]\nsign = 0", "columns.theta1.sign: found 0; expected 1 or -1"),
    "a number": ("[columns]\nt = 1", "columns.t: found 1; expected a header"),
}  # fmt: skip


@pytest.mark.parametrize(("columns", "message"), SETTINGS.values(), ids=SETTINGS)
def test_fault_in_columns_toml_names_file_and_key(columns, message, read):
    with pytest.raises(SettingsError) as caught:
        read(leg_table(), columns)
    assert message in str(caught.value)


def test_a_column_map_above_the_log_is_noted(read, tmp_path):
    read(leg_table(), "[legs.columns]\ntheta1 = {sign = -1}\n")
    below = tmp_path / "day"
    below.mkdir()
    (tmp_path / "legs.csv").rename(below / "legs.csv")
    found = read_leg_log(below / "legs.csv")
    assert found.notes[-1] == (
        f"legs.csv: columns are those of {tmp_path / 'columns.toml'}, the nearest for legs above it"
    )
    named = read_leg_log(below / "legs.csv", columns=tmp_path / "columns.toml")
    assert not any("above it" in note for note in named.notes)


def test_named_columns_file_must_exist(read, tmp_path):
    with pytest.raises(NotFound, match=r"expected a columns\.toml"):
        read(leg_table(), columns=tmp_path / "none.toml")


def test_a_missing_log_is_named_and_not_the_columns_file_of_other_tables_beside_it(tmp_path):
    (tmp_path / "columns.toml").write_text("[constants]\nradius_leg = 0.035\n")
    with pytest.raises(NotFound, match=r"none\.csv: no such file"):
        read_leg_log(tmp_path / "none.csv")


def test_empty_folder_is_no_leg_log(tmp_path):
    with pytest.raises(DataError, match=r"is a folder without path\.csv, run\.json or metadata"):
        read_leg_log(tmp_path)
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "run.json").write_text("{}")
    with pytest.raises(DataError, match=r"; give one of the folders in it, such as .*run$"):
        read_leg_log(tmp_path)


def test_a_bag_is_a_leg_log_whose_topic_is_chosen(tmp_path):
    t, theta = leg_table().t.to_numpy(), leg_table()[list(ANGLES)].to_numpy()
    bag = write_bag(
        tmp_path / "bag", joints(t, theta, topic="/a"), joints(t, -theta, topic="/b"),
        storage="mcap",
    )  # fmt: skip
    with pytest.raises(DataError, match=r"on the topics /a, /b; choose one with --topic NAME"):
        read_leg_log(bag)
    chosen = read_leg_log(bag, names=LegNames(topics=("/b",)))
    np.testing.assert_array_equal(chosen.reference.theta, -theta)
    (tmp_path / "columns.toml").write_text('[legs]\ntopic = "/a"')
    np.testing.assert_array_equal(read_leg_log(bag).reference.theta, theta)
    with pytest.raises(SettingsError, match=r"--topic: found /b, but nothing is read from it"):
        read_leg_log(bag, names=LegNames(topics=("/b",)))


def test_columns_of_a_table_are_named_in_an_option_and_keep_unit_and_sign(read):
    table = leg_table()
    theirs = pd.DataFrame({"t": table.t} | {c: np.degrees(table[f"theta{i}"])
                                            for i, c in enumerate("abcdef", 1)})  # fmt: skip
    units = "".join(f'theta{leg} = {{unit = "deg"}}\n' for leg in range(1, 7))
    found = read(theirs, f"[columns]\n{units}", names=LegNames(joints=tuple("abcdef")))
    np.testing.assert_allclose(found.reference.theta, table[list(ANGLES)], atol=1e-9)


@pytest.mark.reference
def test_logs_of_the_virtual_world_are_read_by_their_names(shared, tmp_path):
    columns = tmp_path / "columns.toml"
    columns.write_text(
        'source = "sim:virtual-world"\n[columns]\n'
        + "".join(f'theta{leg} = "th{leg}"\n' for leg in range(1, 7))
    )
    for file in sorted((shared / "virtual-world" / "walks").glob("*.csv.gz")):
        found = read_leg_log(file, columns=columns)
        table = pd.read_csv(file)
        np.testing.assert_allclose(found.reference.theta, table[[f"th{i}" for i in range(1, 7)]])
