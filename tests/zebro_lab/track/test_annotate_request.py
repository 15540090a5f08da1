# SPDX-License-Identifier: MIT
"""Options of annotate: whether anything is to be written."""

from dataclasses import replace
from pathlib import Path

import pytest

from zebro_lab.track.annotate_request import AnnotateRequest

NOTHING = AnnotateRequest(Path("photos"), photo="p.jpg", plate="1mx1m@1m", robot=Path("r.toml"))


def test_a_photograph_alone_is_nothing_to_write():
    assert NOTHING.is_empty


@pytest.mark.parametrize(
    "option",
    [{"corners": "1,2"}, {"clicks": ("p:a=1,2",)}, {"moves": ("p:1,2,3",)}, {"flips": ("p",)},
     {"deletes": ("p",)}, {"added": Path("more.toml")}],
)  # fmt: skip
def test_each_annotation_is_something_to_write(option):
    assert not replace(NOTHING, **option).is_empty
