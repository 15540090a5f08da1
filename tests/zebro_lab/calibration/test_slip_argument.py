# SPDX-License-Identifier: MIT
"""`--slip`: everything it may name, and every way in which it may name nothing."""

import dataclasses
import json
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.bayes.verdict import State
from model.errors import DefinitionMismatch
from model.slip import SlipDefinition
from model.thesis.traction import slip_traction
from model.walk.path import WalkPath
from model.walk.traction import VelocityCoulomb
from support.bounded_reading import refusal
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import NotFound
from zebro_lab.files.provenance import file_hash

SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "material"
verdict = {{ headline = "{headline}", trustworthy = {trustworthy} }}
law = {{ name = "coulomb-stribeck", stribeck = false }}
[parameters]
slip_stiffness = {{ mean = 20.0 }}
friction = {{ mean = 0.4 }}
[covariance]
matrix = [[1.0, 0.0], [0.0, 0.01]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
"""


@pytest.fixture
def calibration(tmp_path):
    """Return a folder with a slip.toml."""
    text = SLIP_TOML.format(headline="trustworthy", trustworthy="true")
    (tmp_path / "slip.toml").write_text(text)
    return tmp_path


def test_file_and_its_folder_mean_the_same(calibration):
    by_folder, by_file = (parse_slip(str(p)) for p in (calibration, calibration / "slip.toml"))
    assert by_folder.files == by_file.files == (calibration / "slip.toml",)
    assert by_folder.source == by_file.source == "sim:rig-sweep"
    np.testing.assert_array_equal(by_folder.law.values, by_file.law.values)
    assert by_folder.notes == ()


def test_title_has_no_path(calibration):
    for path in (calibration, calibration / "slip.toml"):
        assert parse_slip(str(path)).title == calibration.name
    assert parse_slip("coulomb:0.4").title == "coulomb:0.4"


def test_untrustworthy_calibration_is_said_to_be(calibration):
    text = SLIP_TOML.format(headline="not trustworthy", trustworthy="false")
    (calibration / "slip.toml").write_text(text)
    (note,) = parse_slip(str(calibration)).notes
    assert note == "WARNING: the calibration is not trustworthy"
    assert parse_slip(str(calibration)).doubts == (note,)


def test_what_was_not_tested_is_noted_and_is_no_doubt(calibration):
    headline = "not fully tested; untested: peak"
    text = SLIP_TOML.format(headline=headline, trustworthy="false").replace(
        "trustworthy = false", 'trustworthy = false, state = "not fully tested"'
    )
    (calibration / "slip.toml").write_text(text)
    found = parse_slip(str(calibration))
    assert found.notes == (f"slip: {headline}",)
    assert found.doubts == ()
    assert str(State.AS_TESTED) in text


def test_a_calibration_that_was_edited_by_hand_is_told(calibration):
    file = calibration / "slip.toml"
    outputs = {"slip.toml": file_hash(file)}
    (calibration / "manifest.json").write_text(json.dumps({"outputs": outputs}))
    assert parse_slip(str(calibration)).notes == ()
    file.write_text(file.read_text() + "# mine\n")
    (note,) = parse_slip(str(calibration)).notes
    assert note.startswith(f"WARNING: {file} was changed after it was written")


def test_a_posterior_that_was_deleted_is_told_but_not_one_that_never_was(calibration):
    outputs = {"slip.toml": file_hash(calibration / "slip.toml"), "posterior.nc": "0"}
    (calibration / "manifest.json").write_text(json.dumps({"outputs": outputs}))
    (note,) = parse_slip(str(calibration)).notes
    assert note.startswith(
        f"WARNING: {calibration / 'posterior.nc'}, which manifest.json lists, is"
    )
    assert note.endswith("draws are those of the Gaussian in slip.toml")
    (calibration / "posterior.nc").write_text("")
    assert parse_slip(str(calibration)).notes == ()


def test_a_calibration_that_does_not_exist_names_the_command_that_makes_one(tmp_path):
    with pytest.raises(NotFound, match=r"is not a file or folder; .*; calibrate-slip DATA writes"):
        parse_slip(str(tmp_path / "calibration"))


@given(st.floats(1e-3, 2), st.floats(1e-6, 1))
def test_coulomb_takes_friction_and_velocity(friction, velocity):
    assert parse_slip(f"coulomb:{friction!r}:{velocity!r}").law == VelocityCoulomb(
        friction, velocity
    )


def test_thesis_is_the_sources_curve():
    curve = parse_slip("thesis").law
    B, C, D, _ = curve.law.coefficients(10.0, curve.values)
    np.testing.assert_allclose([B, C, D], [34.34, 1.564, 3.798])


def test_other_definition_is_converted_or_refused(calibration):
    file = calibration / "slip.toml"
    file.write_text(file.read_text().replace('"material"', '"travel"'))
    slip = parse_slip(str(calibration))
    assert slip.law.definition is SlipDefinition.TRAVEL
    assert "converted" in slip.notes[0]
    assert np.isfinite(slip.traction_table(weight=21.0).phi).all()
    with pytest.raises(DefinitionMismatch):
        slip_traction(slip, weight=21.0)


def test_sources_model_takes_the_sources_curve_exactly_and_any_other_as_a_table(calibration):
    assert slip_traction(parse_slip("thesis"), weight=21.0).exact
    for text in ("coulomb:0.4", str(calibration)):
        assert not slip_traction(parse_slip(text), weight=21.0).exact


def test_loads_below_the_tested_are_counted_in_contact_alone(calibration, walked):
    load = np.full((len(walked.t), 6), 5.0)
    load[:, 0] = 1.0
    contact = np.zeros_like(load, dtype=bool)
    contact[:, :2] = True
    path: WalkPath = dataclasses.replace(walked, normal_force=load, contact=contact)
    assert parse_slip(str(calibration)).loads_below_tested(path) == 0.5
    assert parse_slip("coulomb:0.4").loads_below_tested(path) is None


@pytest.mark.parametrize(
    "more", ["verdict = 5", "verdict = [1]", 'verdict = "fine"', "verdict = { headline = [1] }"]
)
def test_a_verdict_that_is_no_table_is_refused(more, calibration):
    file = calibration / "slip.toml"
    file.write_text(re.sub(r"(?m)^verdict = .*$", more, file.read_text()))
    refusal(lambda folder: parse_slip(str(folder)), calibration)
