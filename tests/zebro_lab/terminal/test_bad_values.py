# SPDX-License-Identifier: MIT
"""A value of the wrong type is refused with the value and the type that is expected."""

import pytest


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--duration", "2s", "found '2s'; expected a number"),
        ("--seed", "1.5", "found '1.5'; expected a whole number"),
        ("--gait", "tripot", "'--gait': 'tripot' is not a gait; did you mean 'tripod'?"),
    ],
)
def test_the_value_and_what_is_expected_are_named(run_command, option, value, message):
    ended = run_command("walk", "--slip", "thesis", option, value)
    assert ended.code == 2
    assert message in ended.err
    assert "Value error" not in ended.err
