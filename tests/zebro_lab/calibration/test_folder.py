# SPDX-License-Identifier: MIT
"""`slip.toml` read back, and every way in which it may not be one."""

import resource
import tomllib

import numpy as np
import pytest

from model.slip import Brush, MagicFormula, SidedLaw
from support.short_calibration import short_calibration
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import read_slip, write_tables
from zebro_lab.calibration.lateral_force import LateralForce
from zebro_lab.files.errors import DataError

GOOD = """
schema = 1
slip_definition = "material"
law = { name = "magic-formula", curvature = -0.5, load_sensitivity = false, reference_load = 1.0 }
[parameters]
slip_stiffness = { mean = 20.0 }
shape = { mean = 1.5 }
friction = { mean = 0.4 }
[covariance]
matrix = [[1.0, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.0001]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
"""

DAMAGE = {
    "not TOML": ("schema = 1", "schema 1"),
    "later schema": ("schema = 1", "schema = 2"),
    "no schema": ("schema = 1", ""),
    "unknown law": ("magic-formula", "tragic-formula"),
    "law without fields": ("law = {", "law = 'brush' # {"),
    "unknown option": ("reference_load", "reference_lode"),
    "unknown definition": ('"material"', '"materiel"'),
    "missing parameter": ("friction = { mean = 0.4 }", ""),
    "parameter without a mean": ("{ mean = 0.4 }", "0.4"),
    "text for a number": ("mean = 0.4", "mean = 'big'"),
    "mean next to 0": ("mean = 0.4", "mean = 1e-320"),
    "mean of 0": ("mean = 20.0", "mean = 0.0"),
    "negative mean": ("mean = 20.0", "mean = -20.0"),
    "mean beyond its range": ("mean = 1.5", "mean = 2.5"),
    "mean that is none": ("mean = 1.5", "mean = nan"),
    "ragged covariance": ("[1.0, 0.0, 0.0]", "[1.0, 0.0]"),
    "covariance of other parameters": (", [0.0, 0.0, 0.0001]", ""),
    "one end of a range": ("[2.0, 13.0]", "[2.0]"),
}


def test_curve_is_read_from_the_file_or_its_folder(tmp_path):
    (tmp_path / "slip.toml").write_text(GOOD)
    for path in (tmp_path, tmp_path / "slip.toml"):
        curve = read_slip(path)
        assert curve.law == MagicFormula(-0.5)
        np.testing.assert_array_equal(curve.values, [20.0, 1.5, 0.4])
        np.testing.assert_array_equal(curve.covariance, np.diag([1.0, 0.01, 0.0001]))
        assert curve.definition == "material"
        assert (curve.load_range, curve.slip_range) == ((2.0, 13.0), (0.0, 1.0))


def test_every_law_is_read_with_its_options(tmp_path):
    begin, end = GOOD.index("law ="), GOOD.index("[covariance]")
    sensitive = """law = { name = "magic-formula", curvature = 0.0, load_sensitivity = false }
parameters = { slip_stiffness.mean = 20.0, shape.mean = 1.5, friction.mean = 0.4 }
"""
    (tmp_path / "slip.toml").write_text(GOOD[:begin] + sensitive + GOOD[end:])
    assert read_slip(tmp_path).law == MagicFormula(0.0)


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_file_is_one_line_that_names_it(tmp_path, damage):
    found, put = DAMAGE[damage]
    assert found in GOOD
    (tmp_path / "slip.toml").write_text(GOOD.replace(found, put, 1))
    with pytest.raises(DataError) as caught:
        read_slip(tmp_path)
    message = str(caught.value)
    assert message.startswith(str(tmp_path / "slip.toml"))
    assert "\n" not in message


def test_later_schema_asks_for_a_newer_program(tmp_path):
    (tmp_path / "slip.toml").write_text(GOOD.replace("schema = 1", "schema = 2"))
    with pytest.raises(DataError, match="schema 2, this version reads 1; update zebro-lab"):
        read_slip(tmp_path)


@pytest.mark.parametrize("content", [None, b"\xff\xfe\x00binary"])
def test_what_is_no_calibration_says_what_to_name(tmp_path, content):
    if content is not None:
        (tmp_path / "slip.toml").write_bytes(content)
    with pytest.raises(DataError, match=r"name a slip\.toml or the folder"):
        read_slip(tmp_path)


def test_a_fit_is_read_back_with_its_curve_and_draws(tmp_path):
    calibration = short_calibration()
    write_tables(tmp_path, calibration, inputs={"a.csv": "0" * 64})
    curve, law = read_slip(tmp_path), calibration.posterior.law
    k = len(law.parameters)
    draws = calibration.draws.flat[:, :k]
    assert curve.law == law
    np.testing.assert_allclose(curve.values, draws.mean(axis=0), rtol=1e-6)
    np.testing.assert_allclose(curve.covariance, np.cov(draws.T), rtol=1e-3)
    assert curve.definition == calibration.posterior.blocks.definition
    found, _ = read_draws_of(tmp_path / "posterior.nc", "posterior",
                             [each.name for each in law.parameters], advice="")  # fmt: skip
    for i, parameter in enumerate(law.parameters):
        np.testing.assert_array_equal(np.sort(found[parameter.name]), np.sort(draws[:, i]))
    text = (tmp_path / "slip.toml").read_text()
    assert "SIMULATED data: nothing here was measured." in text
    assert len((tmp_path / "summary.csv").read_text().splitlines()) > k


def test_draws_for_which_there_is_no_space_are_an_error_of_the_system(tmp_path):
    """HDF5 crashes, instead of raising, where it writes to a full disk itself."""
    calibration = short_calibration()
    write_tables(tmp_path, calibration, inputs={})
    sizes = sorted(path.stat().st_size for path in tmp_path.iterdir())
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (sum(sizes[-2:]) // 2, limits[1]))
    try:
        with pytest.raises(OSError, match="File too large"):
            write_tables(tmp_path, calibration, inputs={})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_the_lateral_force_is_in_the_result_where_it_was_measured(tmp_path):
    found = LateralForce(90, 100, 0.2, 0.05, 0.02, 0.4)
    write_tables(tmp_path, short_calibration(), inputs={}, lateral=found.content())
    content = tomllib.loads((tmp_path / "slip.toml").read_text())
    assert content["lateral_force"] == {
        "samples": 90, "mean": 0.2, "sd": 0.05, "mean_over_load": 0.02, "mean_over_traction": 0.4,
    }  # fmt: skip
    read_slip(tmp_path)
    write_tables(tmp_path, short_calibration(), inputs={})
    assert "lateral_force" not in (tmp_path / "slip.toml").read_text()


def test_a_law_with_its_sides_apart_is_read_back(tmp_path):
    apart = """law = { name = "brush", kinetic = false, sides = "apart" }
[parameters]
slip_stiffness.mean = 20.0
friction.mean = 0.4
side_stiffness.mean = 0.1
side_friction.mean = -0.1
"""
    begin, end = GOOD.index("law ="), GOOD.index("[covariance]")
    rows = ", ".join(str([float(i == j) for j in range(4)]) for i in range(4))
    text = GOOD[:begin] + apart + GOOD[end:]
    start = text.index("matrix =")
    text = f"{text[:start]}matrix = [{rows}]\n{text[text.index('[tested]') :]}"
    (tmp_path / "slip.toml").write_text(text)
    assert read_slip(tmp_path).law == SidedLaw(Brush())
    (tmp_path / "slip.toml").write_text(text.replace('"apart"', '"aprt"'))
    with pytest.raises(DataError, match="did you mean 'apart'"):
        read_slip(tmp_path)
