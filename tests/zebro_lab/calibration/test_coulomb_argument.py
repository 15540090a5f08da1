# SPDX-License-Identifier: MIT
"""Coulomb friction as an option, and frictions that nobody means."""

import pytest

from zebro_lab.calibration.coulomb_argument import coulomb_numbers
from zebro_lab.files.errors import SettingsError


@pytest.mark.parametrize("text", ["thesis", "calibration", "coulombs:3", ""])
def test_other_texts_are_not_friction(text):
    assert coulomb_numbers(text) is None


@pytest.mark.parametrize(
    "text", ["coulomb", "coulomb:", "coulomb:x", "coulomb:nan", "coulomb:-1", "coulomb:1:0",
             "coulomb:1:inf", "coulomb:0.4:1:2"]
)  # fmt: skip
def test_what_is_no_friction_law_names_the_option_and_an_example(text):
    with pytest.raises(SettingsError, match=r"--slip: .*coulomb:0\.38:0\.001"):
        coulomb_numbers(text)


@pytest.mark.parametrize(
    ("friction", "question"),
    [("38", "did you mean coulomb:0.38?"), ("100", "did you mean coulomb:1?"), ("2.1", None),
     ("5", None), ("1e9", None)],
)  # fmt: skip
def test_an_improbable_friction_is_refused_and_asked_about_if_it_may_be_percent(friction, question):
    with pytest.raises(SettingsError, match="improbable, expected at most 2") as refused:
        coulomb_numbers(f"coulomb:{friction}")
    assert ("did you mean" in str(refused.value)) == (question is not None)
    assert (question or "") in str(refused.value)


def test_the_largest_friction_is_taken():
    assert coulomb_numbers("coulomb:2:1e-3") == (2.0, 1e-3)
