# SPDX-License-Identifier: MIT
"""The likeliest suspect is named, with those that are hardly less likely; else nobody."""

from tracking.suspect import SuspectValue, suspicion


def test_no_suspect_below_the_threshold_is_named():
    assert suspicion([], remarkable=2.0) == ()
    assert suspicion([SuspectValue("the lens", "+1 % off", 1.9)], remarkable=2.0) == ()
    assert suspicion([SuspectValue("the lens", "+1 % off", 2.1)], remarkable=2.0) != ()


def test_a_clear_suspect_is_named_alone():
    clear = [SuspectValue("the lens", "+1 % off", 20.0), SuspectValue("the tape", "2 mm off", 5.0)]
    (text,) = suspicion(clear, remarkable=2.0)
    assert text.startswith("the lens does not fit the photographs: it seems to be +1 % off")
    assert "tape" not in text


def test_a_rival_is_named_up_to_four_less_likely():
    for less, named in ((3.9, True), (4.1, False)):
        pair = [
            SuspectValue("the lens", "+1 % off", 6.0),
            SuspectValue("the tape", "2 mm off", 6.0 - less),
        ]
        (text,) = suspicion(pair, remarkable=2.0)
        assert ("tape" in text) == named


def test_suspects_that_explain_as_much_cannot_be_told_apart():
    alike = [SuspectValue("the lens", "+1 % off", 6.0), SuspectValue("the tape", "2 mm off", 5.0)]
    (text,) = suspicion(alike, remarkable=2.0)
    assert "cannot be told apart from the tape (2 mm off)" in text
