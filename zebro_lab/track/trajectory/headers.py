# SPDX-License-Identifier: MIT
"""Recognise the columns of a trajectory by their headers."""

import re
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

_HEADERS: Final = {
    "t_s": r"t|t_s|time|time_s|time_?stamps?|stamp|sec|seconds",
    **{
        f"{axis}_m": rf"{axis}|{axis}_m|[tp]_?{axis}|(p|pos|position|translation)[_. ]{axis}"
        rf"|p_rs_r_{axis}|(pose\.)*position\.{axis}|(transform\.)?translation\.{axis}"
        for axis in "xyz"
    },
    **{
        f"q{axis}": rf"q_?{axis}|(q|quat|quaternion|rotation|orientation)[_. ]{axis}|q_rs_{axis}"
        rf"|(pose\.)*orientation\.{axis}|(transform\.)?rotation\.{axis}"
        for axis in "xyzw"
    },
    "yaw_rad": r"yaw|yaw_rad",
}  # fmt: skip
"""Regular expression of each canonical column's header, in lower case and without its unit."""
_WITH_UNIT: Final = re.compile(r"(.*?)\s*[\[(]([^\])]*)[\])]")


class NamedColumn(NamedTuple):
    """A recognised column.

    Attributes:
        header: Its header.
        unit: The unit in brackets after its name; None without one.
    """

    header: str
    unit: str | None


def named_columns(headers: Sequence[str]) -> Mapping[str, NamedColumn]:
    """Recognise the columns of a trajectory, by canonical name; of several that fit, the first.

    >>> named_columns(["#timestamp [ns]", "p_RS_R_x [m]"])["t_s"]
    NamedColumn(header='#timestamp [ns]', unit='ns')
    """
    found: dict[str, NamedColumn] = {}
    for header in headers:
        match = _WITH_UNIT.fullmatch(header.strip())
        name, unit = (match[1], match[2].strip()) if match else (header, None)
        word = name.strip("# ").lower()
        for canonical, pattern in _HEADERS.items():
            if re.fullmatch(pattern, word):
                found.setdefault(canonical, NamedColumn(header, unit))
    return found
