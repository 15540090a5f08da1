# SPDX-License-Identifier: MIT
from pathlib import Path

import numpy as np
import pytest

from model.slip.definition import SlipDefinition, convert_slip
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES, thesis_curve
from support.curve_tables import thesis_table, written_curve
from support.rig_tables import speeds, write
from zebro_lab.calibration.curve_argument import (
    is_curve,
    is_curve_table,
    parse_curve,
    read_curve_table,
)
from zebro_lab.files.errors import DataError, SettingsError

SLIP = np.array([-0.2, 0.03, 0.5])
MATERIAL, TRAVEL = SlipDefinition.MATERIAL, SlipDefinition.TRAVEL


def test_the_thesis_s_curve_is_that_of_its_listing_with_slope_and_definition():
    curve = parse_curve(Path("thesis"))
    expected = THESIS_LAW.force(SLIP, 6.63, THESIS_VALUES)
    np.testing.assert_allclose(curve.force(SLIP, 6.63, MATERIAL), expected)
    assert curve.own_slope(6.63) == pytest.approx(THESIS_VALUES[0] * 6.63)
    assert curve.said(MATERIAL) == ()


def test_slip_ratios_are_converted_to_the_definition_of_the_curve():
    curve, travel = parse_curve(Path("thesis")), convert_slip(SLIP, "material", "travel")
    np.testing.assert_allclose(curve.force(travel, 6.63, TRAVEL), curve.force(SLIP, 6.63, MATERIAL))
    assert "'material' slip is converted to 'travel'" in curve.said(TRAVEL)[0]


def test_slips_that_noise_puts_beyond_the_limit_have_no_counterpart_and_are_left_out(tmp_path):
    path = written_curve(tmp_path / "c.csv", thesis_table().assign(slip_definition="travel"))
    curve, slip = parse_curve(path), np.array([0.2, 1.0, 1.002])
    np.testing.assert_array_equal(np.isnan(curve.force(slip, 5.0, MATERIAL)), [False, True, True])


def test_coulomb_is_friction_times_load_at_any_slip_of_any_definition():
    curve = parse_curve(Path("coulomb:0.4"))
    np.testing.assert_allclose(curve.force(SLIP, 10.0, TRAVEL), [-4.0, 4.0, 4.0])
    assert (curve.own_slope(10.0), curve.said(TRAVEL)) == (np.inf, ())


def test_a_table_is_interpolated_at_its_loads_and_unknown_beyond_its_slips(tmp_path):
    path = written_curve(
        tmp_path / "curve.csv", thesis_table(points=800).query("slip_ratio <= 0.5")
    )
    curve, truth = parse_curve(path), thesis_curve()
    slip = np.array([0.0101, 0.25, 0.49, 0.6])
    found = curve.force(slip, 6.63, MATERIAL)
    np.testing.assert_allclose(found[:3], truth.force(slip[:3], 6.63, definition="material"), 2e-3)
    assert np.isnan(found[3])
    assert curve.loads == pytest.approx((2.13, 6.63, 8.13, 12.75))
    assert curve.own_slope(12.75) == pytest.approx(THESIS_VALUES[0] * 12.75, rel=0.02)


def test_what_names_a_curve_is_told_from_folders(tmp_path):
    assert all(is_curve(Path(text)) for text in ("thesis", "coulomb:0.3"))
    assert is_curve(written_curve(tmp_path / "curve.csv", thesis_table()))
    assert not is_curve(tmp_path)
    assert not is_curve(tmp_path / "lost.csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("coulomb:0.4:0.01", "sets in over a velocity"),
        ("coulomb:38", "did you mean"),
    ],
)
def test_numbers_that_make_no_curve_are_refused(text, message):
    with pytest.raises(SettingsError, match=message):
        parse_curve(Path(text))


def test_forces_at_loads_are_read_with_their_definition(tmp_path):
    table = thesis_table()
    found = read_curve_table(written_curve(tmp_path / "curve.csv", table))
    np.testing.assert_allclose(found.slip, table["slip_ratio"])
    np.testing.assert_allclose(found.load, table["normal_force"])
    np.testing.assert_allclose(found.traction, table["traction_force"])
    assert (str(found.definition), found.source) == ("material", "unknown")
    assert found.files == (tmp_path / "curve.csv",)


def test_headers_units_and_definition_may_be_stated_in_columns_toml(tmp_path):
    table = thesis_table((6.63,)).drop(columns="slip_definition")
    table = table.assign(slip_ratio=100 * table["slip_ratio"]).rename(columns={"slip_ratio": "sx"})
    path = written_curve(tmp_path / "curve.csv", table)
    path.with_name("columns.toml").write_text(
        'source = "real"\n'
        '[columns]\nslip_ratio = {name = "sx", unit = "%", definition = "travel"}\n'
    )
    found = read_curve_table(path)
    assert (found.slip.max(), str(found.definition), found.source) == (1.0, "travel", "real")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.drop(columns="slip_definition"), "definition of the slip ratio is not known"),
        (lambda t: t.drop(columns="traction_force"), "the column of the traction force is missing"),
        (lambda t: t.drop(columns="normal_force"), "normal_force.*is missing"),
        (lambda t: t.head(2), "has 2 points"),
    ],
)
def test_what_a_table_lacks_or_has_twice_is_named(tmp_path, change, message):
    path = written_curve(tmp_path / "curve.csv", change(thesis_table((6.63,))))
    with pytest.raises(DataError, match=message):
        read_curve_table(path)


def test_a_table_of_samples_is_no_table_of_a_curve(tmp_path):
    assert is_curve_table(written_curve(tmp_path / "curve" / "curve.csv", thesis_table()))
    assert not is_curve_table(write(tmp_path / "rig", speeds()))
    assert not is_curve_table(tmp_path)
