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
    ("error", "kind", "named", "values"),
    [
        (PartFailed("keyboard", OSError("a\nb")), RuntimeError, ("keyboard", "OSError: a b"),
         {"part": "keyboard"}),
        (RigTimeout("no answer", waited=0.5, advice="look"), TimeoutError,
         ("no answer", "0.5 s", "look"), {"waited": 0.5}),
        (DeviceFault("overheated", status=7), RuntimeError, ("overheated",), {"status": 7}),
        (LimitExceeded("speed", value=31.0, limit=25.0, unit="rad/s"), ValueError,
         ("speed", "31 rad/s", "25 rad/s"), {"value": 31.0, "limit": 25.0, "unit": "rad/s"}),
        (StaleReading("age", value=2.0, limit=1.0, unit="s"), LimitExceeded,
         ("age", "2 s", "1 s"), {"value": 2.0, "limit": 1.0, "unit": "s"}),
        (FrozenReading("force", value=0.3, limit=0.25), ValueError, ("force", "0.3 s", "0.25 s"),
         {"limit": 0.25}),
        (NotAtRest("it turns", limit=0.1), TimeoutError,
         ("it turns", "0.1 rad/s", "do not touch the discs"), {"limit": 0.1}),
        (ProfileError("is\nodd", file="a.toml", key="b"), ValueError, ("a.toml", "b", "is odd"),
         {"problem": "is\nodd", "file": "a.toml", "key": "b"}),
    ],
)  # fmt: skip
def test_an_error_is_one_line_that_names_its_values_and_keeps_them(error, kind, named, values):
    assert "\n" not in str(error)
    assert all(part in str(error) for part in named)
    assert isinstance(error, RigError)
    assert isinstance(error, kind)
    assert {name: getattr(error, name) for name in values} == values
