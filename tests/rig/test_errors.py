# SPDX-License-Identifier: MIT
"""Errors are one line, keep what they were made of, and are what Python's own are."""

import pytest

from rig.errors import (
    DeviceFault,
    FrozenReading,
    LimitExceeded,
    NotAtRest,
    PartFailed,
    ProfileError,
    RigError,
    RigTimeout,
    StaleReading,
)


@pytest.mark.parametrize(
    ("error", "kind", "message", "values"),
    [
        (PartFailed("keyboard", OSError("a\nb")), RuntimeError,
         "keyboard failed: OSError: a b", {"part": "keyboard"}),
        (RigTimeout("no answer", waited=0.5, advice="look"), TimeoutError,
         "no answer within 0.5 s; look",
         {"waited": 0.5}),
        (DeviceFault("overheated", status=7), RuntimeError, "overheated", {"status": 7}),
        (StaleReading("age", value=2.0, limit=1.0, unit="s"), ValueError,
         "age is 2 s; its limit is 1 s", {"value": 2.0, "limit": 1.0, "unit": "s"}),
        (FrozenReading("force", value=0.3, limit=0.25), ValueError,
         "force stayed the same, bit for bit, for 0.3 s; the limit is 0.25 s", {"limit": 0.25}),
        (NotAtRest("it turns", limit=0.1), TimeoutError,
         "it turns; at rest its mean speed is at most 0.1 rad/s: do not touch the discs",
         {"limit": 0.1}),
        (ProfileError("is\nodd", file="a.toml", key="b"), ValueError, "a.toml, b: is odd",
         {"problem": "is\nodd", "file": "a.toml", "key": "b"}),
        (ProfileError("is odd"), ValueError, "is odd", {"file": None}),
    ],
)  # fmt: skip
def test_an_error_is_one_line_and_keeps_its_values(error, kind, message, values):
    assert str(error) == message
    assert isinstance(error, RigError)
    assert isinstance(error, kind)
    assert {name: getattr(error, name) for name in values} == values


def test_a_limit_names_value_limit_and_unit():
    error = LimitExceeded("speed", value=31.0, limit=25.0, unit="rad/s")
    assert str(error) == "speed is 31 rad/s; its limit is 25 rad/s"
