# SPDX-License-Identifier: MIT
"""The laws that a request leaves to be chosen, the preferred first."""

from dataclasses import replace

import numpy as np
import pytest

from model.slip import LAWS, Brush, MagicFormula, SidedLaw, SlipDefinition
from model.slip.samples import SlipSamples
from zebro_lab.calibration.candidates import candidates
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.files.errors import SettingsError


def samples(*loads):
    run = np.repeat(np.arange(4), 20)
    load = np.resize(loads, 4)[run].astype(float)
    names = tuple("abcd")
    return SlipSamples(np.full(80, 0.1), load, 0.4 * load, run, names, SlipDefinition.MATERIAL)


def test_all_laws_are_compared_at_several_loads():
    found = candidates(CalibrationRequest(law="compare"), samples(4.0, 12.0))
    sensitive = [law.load_sensitivity for law in found.values() if isinstance(law, MagicFormula)]
    assert sensitive == [False, False, True, True]
    assert next(iter(found)) == "magic-formula, one E"
    assert LAWS.keys() - {"magic-formula"} < set(found)


def test_at_one_load_laws_that_differ_by_load_alone_are_left_out():
    found = candidates(CalibrationRequest(law="compare"), samples(8.0))
    others = [name for name in LAWS if name != "magic-formula"]
    assert list(found) == ["magic-formula, one E", *others]


def test_curvatures_of_the_magic_formula_differ_by_load_alone():
    asked = CalibrationRequest()
    assert len(candidates(asked, samples(4.0, 12.0))) == 2
    assert list(candidates(asked, samples(4.0))) == ["magic-formula"]


def test_a_named_law_is_the_only_one():
    assert candidates(CalibrationRequest(law="brush"), samples(4.0, 12.0)) == {"brush": Brush()}


@pytest.mark.parametrize("options", [{"load_sensitivity": True}, {"prior_from": "earlier"}])
def test_what_belongs_to_one_law_is_refused_beside_a_comparison(options):
    with pytest.raises(SettingsError, match="leave out"):
        CalibrationRequest(law="compare", **options)


def test_sides_are_fitted_together_apart_or_both():
    data = samples(4.0, 12.0)
    slip = np.where(data.run % 2, 0.1, -0.1)
    both = replace(data, slip=slip, traction_force=np.sign(slip) * data.traction_force)
    apart = candidates(CalibrationRequest(law="brush", sides="apart"), both)
    assert apart == {"brush": SidedLaw(Brush())}
    auto = candidates(CalibrationRequest(law="brush", sides="auto"), both)
    assert auto == {"brush": Brush(), "brush, sides apart": SidedLaw(Brush())}
    assert list(candidates(CalibrationRequest(law="brush", sides="auto"), data)) == ["brush"]
    with pytest.raises(SettingsError, match="slip has one sign"):
        candidates(CalibrationRequest(law="brush", sides="apart"), data)


def test_sides_are_not_chosen_beside_a_comparison_of_laws():
    with pytest.raises(SettingsError, match="choose --sides together or apart"):
        CalibrationRequest(law="compare", sides="auto")


def test_one_sign_of_slip_is_told_before_a_fit_of_both_sides(sweep, run_command, tmp_path):
    out = tmp_path / "out"
    ended = run_command("calibrate-slip", sweep, "--sides", "apart", "--out", out)
    assert (ended.code, out.exists()) == (2, False)
    assert "--sides: slip has one sign in these data" in ended.err
