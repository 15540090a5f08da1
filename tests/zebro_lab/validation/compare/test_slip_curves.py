# SPDX-License-Identifier: MIT
"""Slip curves are compared at common loads; a given one is judged by the calibration's band."""

import json
from pathlib import Path

import numpy as np
import pytest

from model.slip.magic_formula import magic_formula
from model.slip.thesis_curve import THESIS_VALUES
from support.compared_folders import calibration
from support.compared_folders import compared as differences_of
from support.curve_tables import thesis_table, written_curve
from support.short_calibration import short_calibration
from zebro_lab.calibration.folder import write_tables
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.validation.compare.stage import compare

pytestmark = pytest.mark.usefixtures("blank_pictures")


def compared(first, second, out):
    """Compare two; return the comparison, and quantities by name."""
    done = compare(Path(first), Path(second), out=out)
    return done, {each.name: each for each in done.comparison.quantities}


def test_a_curve_of_more_friction_is_outside_and_said_where_and_by_how_much(tmp_path):
    fitted = calibration(tmp_path / "fitted", friction=0.4, sd=0.01)
    table = thesis_table((7.5,), points=400)
    force = magic_formula(table["slip_ratio"], 40.0, 1.5, 4.5, -1.0)
    path = written_curve(tmp_path / "curve.csv", table.assign(traction_force=force))
    done, by_name = compared(fitted, path, tmp_path / "out")
    peak = by_name["peak force at 7.5 N"]
    assert peak.quantiles(0)[0] == pytest.approx(0.4 * 7.5, rel=0.01)
    assert peak.quantiles(1) == pytest.approx((4.5, 4.5, 4.5), rel=1e-3)
    assert by_name["slope at zero slip at 7.5 N"].quantiles(1)[0] == pytest.approx(
        40 * 1.5 * 4.5, rel=0.01
    )
    place = done.comparison.place
    assert not place.inside
    assert place.share_outside > 0.5
    words = done.comparison.notes[-1]
    assert "outside" in words
    assert "above" in words


def test_the_calibration_s_own_curve_lies_inside_and_the_order_is_kept(tmp_path):
    fitted = calibration(tmp_path / "fitted", friction=0.4, sd=0.01)
    slip = np.linspace(0, 1, 400)
    table = thesis_table((5.0,), points=400).assign(
        traction_force=np.minimum(20.0 * slip, 10.0) * 0 + 5.0 * 0.4 * _regular(slip)
    )
    path = written_curve(tmp_path / "own.csv", table)
    done, by_name = compared(path, fitted, tmp_path / "out")
    assert done.comparison.names == ("own.csv", "fitted")
    assert done.comparison.place.inside
    assert "inside" in done.comparison.notes[-1]
    assert by_name["peak force at 5 N"].draws[0].shape == (1,)
    assert list(done.comparison.curves[0].bands[0, 0]) == list(
        done.comparison.curves[0].bands[0, 2]
    )


def _regular(slip):
    """Coulomb friction with the slope 20 at zero slip, regularised as by the law."""
    u = np.clip(slip / (1.5 * 0.4 / 20.0), -1, 1)
    return 0.5 * u * (3 - u**2)


def test_a_load_at_which_the_given_curve_is_unknown_has_no_peak(tmp_path):
    fitted = calibration(tmp_path / "fitted", friction=0.4, sd=0.01)
    table = thesis_table((4.0, 7.5), points=400)
    braking = table["normal_force"] < 5  # which the calibration did not test
    table.loc[braking, ["slip_ratio", "traction_force"]] *= -1
    table = table[~braking | (table["slip_ratio"] < -0.1)]
    path = written_curve(tmp_path / "curve.csv", table)
    _, by_name = compared(fitted, path, tmp_path / "out")
    assert "peak force at 7.5 N" in by_name
    assert "peak force at 4 N" not in by_name


def test_friction_alone_has_no_peak_slip_and_no_slope_to_compare(tmp_path):
    fitted = calibration(tmp_path / "fitted")
    _, by_name = compared(fitted, "coulomb:0.4", tmp_path / "out")
    assert {name.split(" at ")[0] for name in by_name} == {"peak force"}
    assert by_name["peak force at 7.5 N"].quantiles(1)[0] == pytest.approx(3.0)


def test_data_of_the_calibration_are_in_the_panel_of_their_load(tmp_path):
    write_tables(tmp_path, short_calibration(), inputs={})
    done, by_name = compared(tmp_path, "thesis", tmp_path / "out")
    blocks = short_calibration().posterior.blocks
    for curve in done.comparison.curves:
        near = np.abs(blocks.normal_force - curve.load) <= 0.1 * curve.load
        np.testing.assert_allclose(curve.points[1], blocks.traction_force[near])
    heavy = done.comparison.curves[-1]
    assert by_name[f"slope at zero slip at {heavy.load:.3g} N"].quantiles(1)[0] == pytest.approx(
        THESIS_VALUES[0] * heavy.load
    )
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert manifest["of"] == "calibration and curve"
    assert manifest["place"]["inside"] == done.comparison.place.inside


def test_slip_of_another_definition_is_converted_and_said(tmp_path):
    fitted = calibration(tmp_path / "fitted", definition="travel")
    done, _ = compared(fitted, "thesis", tmp_path / "out")
    assert any("'material' slip is converted to 'travel'" in x for x in done.comparison.notes)
    assert done.comparison.definition == "travel"


@pytest.mark.parametrize(
    ("second", "error", "message"),
    [
        ("far.csv", DataError, "is for 100 N: no load is common"),
        ("coulomb:0.4:0.1", SettingsError, "sets in over a velocity"),
    ],
)
def test_a_curve_without_anything_in_common_is_refused(
    tmp_path, monkeypatch, second, error, message
):
    fitted = calibration(tmp_path / "fitted")
    written_curve(tmp_path / "far.csv", thesis_table((100.0,)))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=message):
        compare(fitted, Path(second), out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_two_curves_are_no_comparison_of_a_calibration(tmp_path):
    with pytest.raises(SettingsError, match=r"neither thesis nor coulomb:0\.4 is a calibration"):
        compare(Path("thesis"), Path("coulomb:0.4"), out=tmp_path / "out")


def test_more_friction_is_more_traction_and_the_same_slope(tmp_path):
    one = calibration(tmp_path / "one")
    other = calibration(tmp_path / "other", friction=0.44)
    _, by_name = differences_of(one, other, tmp_path / "out")
    traction = by_name["peak force at 7.5 N"]
    assert traction.median == pytest.approx(0.04 * 7.5, abs=0.04)
    # 0.04 apart, each with a standard deviation of 0.01.
    assert traction.probability == pytest.approx(0.9977, abs=0.004)
    assert traction.clear
    slope = by_name["slope at zero slip at 7.5 N"]
    assert not slope.clear
    assert slope.probability == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize(
    ("options", "problem"),
    [({"definition": "travel"}, "no axis"), ({"loads": (20.0, 30.0)}, "no load is common")],
)
def test_calibrations_without_anything_in_common_are_refused(tmp_path, options, problem):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", **options)
    with pytest.raises(DataError, match=problem):
        compare(one, other, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()
