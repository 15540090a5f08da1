# SPDX-License-Identifier: MIT
"""Mean and scatter of a lateral force are those of all kept samples, and a large mean is said."""

import numpy as np
import pandas as pd
import pytest

from support.rig_tables import RADII, columns
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError

ROWS = 3000


def table(lateral):
    """Return a sweep whose load cell reports a lateral force."""
    rng = np.random.default_rng(1)
    slip = np.repeat(np.linspace(-0.2, 0.3, 6), ROWS // 6) + rng.normal(0, 0.003, ROWS)
    load = np.repeat([6.0, 12.0], ROWS // 2) + rng.normal(0, 0.1, ROWS)
    made = pd.DataFrame({
        "t": np.arange(ROWS) * 0.004,
        "omega_leg": np.full(ROWS, 12.0),
        "omega_ground": (1 - slip) * 12 * 0.035 / 0.12,
        "normal_force": load,
        "traction_force": load * 0.4 * np.tanh(30 * slip) + rng.normal(0, 0.05, ROWS),
        "run": np.repeat(np.arange(6), ROWS // 6),
    })  # fmt: skip
    return made if lateral is None else made.assign(lateral_force=lateral)


def read(folder, made, text=RADII, name="rig.parquet"):
    columns(folder, text)
    made.to_parquet(folder / name, row_group_size=900)
    return read_rig_data([folder / name])


def noise(mean, sd=0.2):
    return mean + np.random.default_rng(2).normal(0, sd, ROWS)


def test_mean_and_scatter_are_those_of_all_samples_in_si(tmp_path):
    made = table(noise(0.05))
    found = read(tmp_path, made.assign(Fy=1000 * made.pop("lateral_force")), RADII
                 + '[columns.lateral_force]\nname = "Fy"\nunit = "mN"\n')  # fmt: skip
    force = made["Fy"] / 1000 if "Fy" in made else noise(0.05)
    lateral = found.lateral
    assert lateral is not None
    assert (lateral.samples, lateral.of) == (ROWS, ROWS)
    assert lateral.mean == pytest.approx(force.mean())
    assert lateral.sd == pytest.approx(force.std(ddof=0))
    assert lateral.over_load == pytest.approx((force / made["normal_force"]).mean())
    assert lateral.over_traction == pytest.approx(
        force.mean() / made["traction_force"].abs().mean()
    )
    assert "misaligned" not in " ".join(found.notes)
    assert any(note.startswith("lateral force: mean 0.0") for note in found.notes)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_mean_that_is_not_small_next_to_traction_is_said(tmp_path, sign):
    found = read(tmp_path, table(noise(sign * 0.8)))
    (said,) = [note for note in found.notes if note.startswith("lateral force")]
    assert "of that of traction" in said
    assert "they may be misaligned" in said


def test_without_the_column_nothing_is_said(tmp_path):
    found = read(tmp_path, table(None))
    assert found.lateral is None
    assert "lateral" not in " ".join(found.notes)


def test_rows_left_out_and_empty_cells_do_not_count(tmp_path):
    force = noise(0.1)
    force[::7] = np.nan
    found = read(tmp_path, table(force), RADII + "[rows]\nkeep = ['t > 0.5']")
    kept = np.arange(ROWS) * 0.004 > 0.5
    there = kept & ~np.isnan(force)
    assert found.lateral is not None
    assert (found.lateral.samples, found.lateral.of) == (there.sum(), kept.sum())
    assert found.lateral.mean == pytest.approx(force[there].mean())
    assert f"of {there.sum()} of {kept.sum()} samples" in found.lateral.text


def test_a_second_table_without_it_counts_among_all_samples(tmp_path):
    read(tmp_path, table(noise(0.3)), name="a.parquet")
    other = table(None)
    other["traction_force"] += 0.01
    other.to_parquet(tmp_path / "b.parquet")
    found = read_rig_data([tmp_path / "a.parquet", tmp_path / "b.parquet"])
    assert found.lateral is not None
    assert (found.lateral.samples, found.lateral.of) == (ROWS, 2 * ROWS)


def test_a_cell_that_is_no_number_is_an_error(tmp_path):
    made = table(None).assign(lateral_force="sideways")
    with pytest.raises(DataError, match="lateral_force"):
        read(tmp_path, made)
