# SPDX-License-Identifier: MIT
"""Parquet tables that are read part by part give the runs, checks and blocks of the whole."""

import numpy as np
import pytest

from model.bayes.blocks import block_means
from support.rig_tables import RADII, columns
from zebro_lab.calibration import rig_data, streamed_part
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError

ROWS = 3000


@pytest.fixture
def small(monkeypatch):
    """Take tables of more than a hundred rows for too large, and read 700 rows at a time."""
    monkeypatch.setattr(rig_data, "MOST_ROWS", 100)
    monkeypatch.setattr(rig_data, "MEANS", ROWS // 5)
    monkeypatch.setattr(streamed_part, "PART", 700)


def table(**changes):
    import pandas as pd

    rng = np.random.default_rng(1)
    slip = np.repeat(np.linspace(-0.2, 0.3, 6), ROWS // 6) + rng.normal(0, 0.003, ROWS)
    load = 8 + rng.normal(0, 0.1, ROWS)
    return pd.DataFrame({
        "t": np.arange(ROWS) * 0.004,
        "omega_leg": np.full(ROWS, 12.0),
        "omega_ground": (1 - slip) * 12 * 0.035 / 0.12,
        "normal_force": load,
        "traction_force": load * 0.4 * np.tanh(30 * slip) + rng.normal(0, 0.05, ROWS),
        "run": np.repeat([4, 1, 4, 2, 3, 5], ROWS // 6),
        "warm": np.repeat([20.0, 20, 30, 30, 20, 20], ROWS // 6),
    }).assign(**changes)  # fmt: skip


def read(folder, made, text=RADII):
    columns(folder, text)
    made.to_parquet(folder / "rig.parquet", row_group_size=900)
    return read_rig_data([folder / "rig.parquet"])


def both(tmp_path, request, made, text=RADII):
    whole = read(tmp_path, made, text)
    request.getfixturevalue("small")
    return whole, read(tmp_path, made, text)


STATED = 'covariates.warmth = {name = "warm", unit = "degC"}\n' + RADII


@pytest.mark.parametrize(
    "text",
    [
        STATED,
        RADII + "[runs]\nby = ['warm']",
        RADII + "[runs]\ngap = '10 ms'\n[rows]\nkeep = ['t > 0.5', 'warm < 25']",
        RADII + "# none",
    ],
    ids=["run column", "by", "gap and rows left out", "one run"],
)
def test_runs_and_blocks_are_those_of_the_whole(tmp_path, request, text):
    made = table()
    made.loc[ROWS // 2 :, "t"] += 1.0
    if "none" in text:
        made = made.drop(columns="run")
    whole, parts = both(tmp_path, request, made, text)
    assert whole.samples.fine is None
    assert parts.samples.fine is not None
    assert parts.samples.run_names == whole.samples.run_names
    assert parts.samples.definition is whole.samples.definition
    assert int(parts.samples.fine.length.sum()) == len(whole.samples)
    one, other = (block_means(data.samples, n) for data, n in ((parts, 4), (whole, 20)))
    for name in ("slip", "normal_force", "traction_force"):
        np.testing.assert_allclose(
            one.run_mean(getattr(one, name) * one.count) / one.run_mean(1.0 * one.count),
            other.run_mean(getattr(other, name) * other.count) / other.run_mean(1.0 * other.count),
            rtol=1e-3, atol=1e-4,
        )  # fmt: skip
    assert set(whole.notes) - set(parts.notes) == set()
    assert any("too many for memory" in note for note in parts.notes)
    if whole.samples.covariate is not None:
        assert parts.samples.covariate is not None
        assert parts.samples.covariate[0].name == whole.samples.covariate[0].name
        np.testing.assert_allclose(parts.samples.covariate[1], whole.samples.covariate[1])


@pytest.mark.parametrize(
    ("changes", "column", "row"),
    [
        ({"normal_force": np.where(np.arange(ROWS) == 1700, -8.0, 8.0)}, "normal_force", 1701),
        (
            {"traction_force": np.where(np.arange(ROWS) == 2200, np.nan, 1.0)},
            "traction_force",
            2201,
        ),
        ({"t": np.where(np.arange(ROWS) == 701, 0.0, np.arange(ROWS) * 0.004)}, "t", 702),
    ],
)
def test_a_faulty_row_is_named_by_its_row_in_the_file(tmp_path, small, changes, column, row):
    with pytest.raises(DataError) as raised:
        read(tmp_path, table(**changes))
    assert (raised.value.column, raised.value.row) == (column, row)


def test_what_is_judged_of_a_whole_table_is_judged(tmp_path, small):
    with pytest.raises(DataError, match="opposes the slip"):
        read(tmp_path, table().assign(traction_force=lambda t: -t["traction_force"]))
    with pytest.raises(DataError, match="no row"):
        read(tmp_path / "other", table(), RADII + "[rows]\nkeep = ['t < -1']")


def test_copies_are_left_out_and_other_tables_join(tmp_path, small):
    columns(tmp_path, RADII)
    made = table()
    made.to_parquet(tmp_path / "a.parquet")
    made.to_parquet(tmp_path / "b.parquet")
    table().assign(traction_force=lambda t: 1.01 * t["traction_force"]).to_csv(
        tmp_path / "c.csv", index=False
    )
    data = read_rig_data([tmp_path])
    assert data.samples.n_runs == 12
    assert data.samples.fine is not None
    assert len(data.samples.fine.count) == len(data.samples)
    assert any("a" in note and "b" in note for note in data.repeated)


def test_angles_of_the_discs_are_passed_over_with_a_note(tmp_path, request):
    whole, means = both(tmp_path, request, table(angle_leg=np.arange(ROWS) * 0.004 * 12))
    assert whole.samples.angles is not None
    assert means.samples.angles is None
    assert any("angles of the discs are not used" in note for note in means.notes)
