# SPDX-License-Identifier: MIT
"""The column map that is guessed from a header."""

import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.written_bags import joints, write_bag
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.exchange.column_guesses import guess_columns
from zebro_lab.exchange.columns_template import render_columns
from zebro_lab.exchange.init_stage import write_columns_template
from zebro_lab.files.errors import AlreadyExists, DataError, SettingsError
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import RigColumns

N = 40


def tyre() -> pd.DataFrame:
    return pd.DataFrame({
        "ET": np.arange(N) * 0.01, "V": 40.0, "FX": np.linspace(-2, 2, N), "FY": 0.1,
        "FZ": np.full(N, -5.0), "SL": np.linspace(-0.1, 0.1, N), "SR": np.linspace(-0.12, 0.1, N),
    })  # fmt: skip


def rig() -> pd.DataFrame:
    return pd.DataFrame({
        "t [ms]": np.tile(np.arange(N / 2) * 4, 2), "kappa_set": np.repeat([0.1, 0.2], N // 2),
        "Fn (N)": 6.0, "Ft (kN)": 1e-3, "omega_l": 12.0, "omega_g": np.repeat([3.15, 2.8], N // 2),
        "kappa_inst": 0.1, "operator": "a",
    })  # fmt: skip


def template(folder: Path, table: pd.DataFrame) -> tuple[str, RigColumns]:
    table.to_csv(folder / "rig.csv", index=False)
    path = write_columns_template(folder / "rig.csv").file
    text = path.read_text()
    (folder / "checked.toml").write_text(text.replace('= "?"', '= "travel"').replace('?"', '"'))
    return text, read_columns(folder / "checked.toml")


def test_tyre_bench_header_is_recognised(tmp_path):
    text, columns = template(tmp_path, tyre())
    names = {canonical: mapped.name for canonical, mapped in columns.columns.items()}
    assert names == {"t": "ET", "slip_ratio": "SL", "normal_force": "FZ", "traction_force": "FX"}
    assert columns.columns["normal_force"].factor == -1
    assert """name = "SL?"  # first -0.1, from -0.1 to 0.1; CHECK: could also be 'SR'""" in text
    assert 'sign = "-1?"  # CHECK: negative in the file' in text
    assert '#   "V": first 40, from 40 to 40' in text


def test_rig_header_gives_units_and_prefers_speeds(tmp_path):
    text, columns = template(tmp_path, rig())
    factors = {canonical: mapped.factor for canonical, mapped in columns.columns.items()}
    assert factors == {
        "t": 1e-3, "omega_leg": 1, "omega_ground": 1, "normal_force": 1, "traction_force": 1e3,
    }  # fmt: skip
    assert '# name = "kappa_inst"' in text
    assert '#   "operator": first "a"' in text


def test_a_template_is_refused_until_its_guesses_are_checked(tmp_path):
    text, _ = template(tmp_path, tyre())
    with pytest.raises(
        SettingsError, match="10 values are guesses that nobody has checked"
    ) as all_:
        read_rig_data([tmp_path])
    assert str(all_.value).count('?"') == 10 + 1  # and the advice to delete it
    one = text.replace('?"', '"').replace('unit = "s"', 'unit = "s?"')
    (tmp_path / "columns.toml").write_text(one)
    with pytest.raises(SettingsError, match=r'a value is a guess .* columns\.t\.unit = "s\?"'):
        read_rig_data([tmp_path])


def test_tables_of_several_kinds_share_one_file(tmp_path):
    pd.DataFrame({"t": [0, 1], "x": [0, 1], "y": [0, 1]}).to_csv(tmp_path / "a.csv", index=False)
    names = ["t", *(f"theta{leg}" for leg in range(1, 7))]
    pd.DataFrame({name: np.linspace(0, 1, 5) for name in names}).to_csv(
        tmp_path / "legs.csv", index=False
    )
    write_columns_template(tmp_path / "a.csv")
    written = write_columns_template(tmp_path / "legs.csv")
    assert (written.kind, list(tomllib.loads(written.file.read_text()))) == (
        "legs", ["track", "legs"],
    )  # fmt: skip
    assert len(read_leg_log(tmp_path / "legs.csv").reference.t) == 5
    with pytest.raises(AlreadyExists):
        write_columns_template(tmp_path / "legs.csv")


def test_template_reads_its_data_once_the_gaps_are_filled(tmp_path):
    text, _ = template(tmp_path, rig())
    file = tmp_path / "columns.toml"
    text = text.replace('?"', '"')
    for comment in ('# radius_leg = "35 mm" ', '# radius_ground = "120 mm"', '# source = "real"',
                    '# by = ["SET_POINT"]'):  # fmt: skip
        assert comment in text
        text = text.replace(comment, comment[2:].replace("SET_POINT", "kappa_set"))
    file.write_text(text)
    data = read_rig_data([tmp_path])
    assert (len(data.samples), data.samples.n_runs, data.source) == (N, 2, "real")


@given(
    st.lists(st.text(min_size=1), min_size=1, max_size=6, unique=True),
    st.sampled_from(["rig", "legs", "imu", "track"]),
)
def test_any_header_gives_a_template_that_parses(names, kind):
    table = RawTable(Path("a.csv"), {name: pd.Series([1.0, 2.0]) for name in names})
    text = render_columns(table, kind, guess_columns(table, kind), sectioned=kind != "rig")
    read = tomllib.loads(text).get(kind, tomllib.loads(text)).get("columns", {})
    assert {each["name"].removesuffix("?") for each in read.values()} <= {
        name.removesuffix("?") for name in names
    }


def test_existing_file_is_kept_unless_forced(tmp_path):
    tyre().to_csv(tmp_path / "rig.csv", index=False)
    (tmp_path / "columns.toml").write_text("# mine")
    with pytest.raises(AlreadyExists, match=r"replace it with --force; .* such as \[rig\.columns"):
        write_columns_template(tmp_path / "rig.csv")
    assert (tmp_path / "columns.toml").read_text() == "# mine"
    write_columns_template(tmp_path / "rig.csv", force=True)
    assert "FZ" in (tmp_path / "columns.toml").read_text()


def test_a_ros_log_is_told_with_the_command_that_reads_it(tmp_path):
    log = write_bag(tmp_path / "log", joints([0.0, 0.1], np.zeros((2, 6))))
    with pytest.raises(DataError, match=r"is not a table file; .* import takes a ROS log as --leg"):
        write_columns_template(log / "log.db3")
    assert not list(tmp_path.rglob("columns.toml"))
